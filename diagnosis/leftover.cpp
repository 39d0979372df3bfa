#include "diagnosis/leftover.hpp"

#include <algorithm>
#include <map>
#include <numeric>

namespace joulepath {
namespace {

/// Loss that one free column buys by chance, and how much more counts as a finding: calibrated on
/// development cases.
constexpr double kChancePerColumn = 3.0;
constexpr double kLeastEvidence = 120.0;
constexpr double kLeastShare = 0.06;

std::vector<std::size_t> every_run(const Equations& equations) {
  std::vector<std::size_t> runs(equations.runs.size());
  std::iota(runs.begin(), runs.end(), std::size_t{0});
  return runs;
}

}  // namespace

Leftover find_leftover(const Identification& id, const std::vector<int>& columns) {
  const Equations& equations = id.equations;
  const LinearProblem problem = without_calibration(equations, every_run(equations), id.dispersion);
  const double nothing = solve(problem, {}, id.dispersion).loss;
  const double explained = solve(problem, columns, id.dispersion).loss;
  std::map<std::string, std::vector<int>> families;
  std::vector<int> all = columns;
  for (int k : equations.columns_of(Column::Kind::dictionary)) {
    const DictionaryEntry& entry =
        equations.dictionary[static_cast<std::size_t>(equations.columns[static_cast<std::size_t>(k)].owner)];
    families[entry.family + " (" + entry.channel + ")"].push_back(k);
    all.push_back(k);
  }
  const auto chance = [](std::size_t count) { return kChancePerColumn * static_cast<double>(count); };
  Leftover leftover;
  leftover.evidence =
      explained - solve(problem, all, id.dispersion).loss - chance(all.size() - columns.size());
  const double possible = std::max(1.0, (nothing - explained) + std::max(0.0, leftover.evidence));
  leftover.share = std::clamp(leftover.evidence / possible, 0.0, 1.0);
  leftover.significant = leftover.evidence > kLeastEvidence && leftover.share > kLeastShare;
  if (!leftover.significant) return leftover;
  std::vector<std::pair<double, std::string>> gains;
  for (const auto& [name, family] : families) {
    std::vector<int> with_family = columns;
    with_family.insert(with_family.end(), family.begin(), family.end());
    gains.push_back(
        {explained - solve(problem, with_family, id.dispersion).loss - chance(family.size()), name});
  }
  std::stable_sort(gains.begin(), gains.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  for (std::size_t k = 0; k < gains.size() && k < 3; ++k)
    if (gains[k].first > 0.2 * gains[0].first && gains[k].first > 0)
      leftover.description += (leftover.description.empty() ? "depends on " : ", then ") + gains[k].second;
  return leftover;
}

}  // namespace joulepath
