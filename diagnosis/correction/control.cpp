#include "diagnosis/correction/control.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "diagnosis/correction/judged_model.hpp"
#include "diagnosis/where/gap.hpp"

namespace joulepath {
namespace {

/// Labels of named effects, and of effects that the data cannot separate from them.
std::set<std::string> labels_spoken_for(const std::vector<ActiveEffect>& named,
                                        const std::vector<Cause>& causes) {
  std::set<std::string> labels;
  for (const Cause& cause : causes)
    labels.insert(cause.indistinguishable_from.begin(), cause.indistinguishable_from.end());
  for (const ActiveEffect& effect : named) labels.insert(effect.candidate.label());
  return labels;
}

ActiveEffect with_amplitudes(const Candidate& candidate, const Explanation& explanation) {
  ActiveEffect effect{.candidate = candidate};
  for (std::size_t k = 0;
       k < explanation.columns.size() && effect.amplitude.size() < candidate.amplitude.size(); ++k)
    effect.amplitude.push_back(explanation.mean[static_cast<Eigen::Index>(k)]);
  return effect;
}

}  // namespace

Control wrong_candidate(const Examination& x, const std::vector<ActiveEffect>& named,
                        const std::vector<Cause>& causes, const EnergyGap& gap) {
  if (named.empty()) return {};
  const std::set<std::string> spoken_for = labels_spoken_for(named, causes);
  for (const Explanation& e : x.id.explanations) {
    if (e.candidates.size() != 1) continue;
    const Candidate& candidate = x.id.equations.candidates[static_cast<std::size_t>(e.candidates.front())];
    if (spoken_for.contains(candidate.label()) || candidate.effect().delays_channels) continue;
    const double left_J = absolute_gap_J(judged_energies(x, judged_fit(x, {with_amplitudes(candidate, e)})));
    return {candidate.label(), gap.before_J > 0 ? 1 - left_J / gap.before_J : 0.0};
  }
  return {};
}

}  // namespace joulepath
