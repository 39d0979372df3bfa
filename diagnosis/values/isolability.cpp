#include "diagnosis/values/isolability.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <set>

#include "diagnosis/thresholds.hpp"
#include "model/text_of_list.hpp"

namespace joulepath {
namespace {

/// All sets of nodes that are neighbors each of each and that no further node extends (Bron and Kerbosch,
/// Communications of the ACM 16, 1973). Neighbors of the pivot are found in sets with it or with a node that
/// is none of its neighbors (Tomita, Tanaka and Takahashi, Theoretical Computer Science 363, 2006).
void maximal_cliques(const std::vector<std::set<std::size_t>>& neighbors, std::vector<std::size_t> clique,
                     std::set<std::size_t> open, std::set<std::size_t> done,
                     std::vector<std::vector<std::size_t>>& found) {
  if (open.empty() && done.empty() && clique.size() > 1) {
    std::ranges::sort(clique);
    found.push_back(clique);
  }
  const auto among = [&](const std::set<std::size_t>& nodes, std::size_t node) {
    std::set<std::size_t> both;
    std::ranges::set_intersection(nodes, neighbors[node], std::inserter(both, both.end()));
    return both;
  };
  if (open.empty()) return;
  const std::size_t pivot =
      *std::ranges::max_element(open, {}, [&](std::size_t node) { return among(open, node).size(); });
  std::vector<std::size_t> starts;
  std::ranges::set_difference(open, neighbors[pivot], std::back_inserter(starts));
  for (const std::size_t node : starts) {
    std::vector<std::size_t> larger = clique;
    larger.push_back(node);
    maximal_cliques(neighbors, larger, among(open, node), among(done, node), found);
    open.erase(node);
    done.insert(node);
  }
}

}  // namespace

std::vector<std::string> unseen_effects(const Isolability& isolability) {
  std::vector<std::string> labels;
  for (const Isolability::Effect& effect : isolability.effects)
    if (effect.probability_seen < kShareSeen && !effect.is_found) labels.push_back(effect.effect);
  return labels;
}

std::vector<Isolability::Pair> inseparable_pairs(const Isolability& isolability) {
  std::vector<Isolability::Pair> pairs;
  std::ranges::copy_if(isolability.pairs, std::back_inserter(pairs), [](const Isolability::Pair& pair) {
    return pair.probability_told_apart < kShareSeen;
  });
  return pairs;
}

std::vector<std::vector<std::string>> inseparable_groups(const Isolability& isolability) {
  const std::vector<Isolability::Effect>& effects = isolability.effects;
  std::vector<std::set<std::size_t>> neighbors(effects.size());
  const auto index = [&](const std::string& label) {
    return static_cast<std::size_t>(std::ranges::find(effects, label, &Isolability::Effect::effect) -
                                    effects.begin());
  };
  std::set<std::size_t> nodes;
  for (const Isolability::Pair& pair : inseparable_pairs(isolability)) {
    const std::size_t a = index(pair.effect), b = index(pair.other);
    neighbors[a].insert(b), neighbors[b].insert(a);
    nodes.insert({a, b});
  }
  std::vector<std::vector<std::size_t>> cliques;
  maximal_cliques(neighbors, {}, nodes, {}, cliques);
  std::ranges::stable_sort(cliques, std::ranges::greater{}, &std::vector<std::size_t>::size);
  std::vector<std::vector<std::string>> groups;
  for (const std::vector<std::size_t>& clique : cliques) {
    groups.emplace_back();
    for (std::size_t k : clique) groups.back().push_back(effects[k].effect);
  }
  return groups;
}

std::vector<std::string> isolability_notes(const Isolability& isolability) {
  std::vector<std::string> notes, groups;
  if (const std::vector<std::string> unseen = unseen_effects(isolability); !unseen.empty())
    notes.push_back("effects of their usual size that these runs would not show: " +
                    text_of_list(unseen, ", "));
  for (const std::vector<std::string>& group : inseparable_groups(isolability))
    groups.push_back(text_of_list(group, " or "));
  if (!groups.empty())
    notes.push_back("effects of their usual size that these runs could not tell apart: " +
                    text_of_list(groups, "; "));
  return notes;
}

}  // namespace joulepath
