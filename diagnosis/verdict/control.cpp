#include "diagnosis/verdict/control.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "diagnosis/evidence/held_out.hpp"
#include "diagnosis/verdict/ceiling.hpp"
#include "diagnosis/where/gap.hpp"

namespace joulepath {
namespace {

/// Labels that are named, or that the data cannot tell from a named one.
std::set<std::string> labels_spoken_for(const Examination& x) {
  std::set<std::string> labels;
  for (const Cause& cause : x.report.causes)
    labels.insert(cause.indistinguishable_from.begin(), cause.indistinguishable_from.end());
  for (const ActiveEffect& effect : x.named) labels.insert(effect.candidate.label());
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

void report_control(Examination& x) {
  const double base_J = x.report.gap.energy.before_J;
  x.report.ceiling_shrink_fraction = ceiling_shrink_fraction(x);
  if (x.named.empty()) return;
  const std::set<std::string> spoken_for = labels_spoken_for(x);
  for (const Explanation& e : x.id.explanations) {
    if (e.candidates.size() != 1) continue;
    const Candidate& candidate = x.id.equations.candidates[static_cast<std::size_t>(e.candidates.front())];
    if (spoken_for.contains(candidate.label()) || candidate.shape.name == "time_misalignment") continue;
    const ModelState wrong = refit_on_diagnosis(x.diagnosis, x.id, {with_amplitudes(candidate, e)});
    x.report.control_effect = candidate.label();
    x.report.control_shrink_fraction =
        base_J > 0
            ? 1 - absolute_gap_J(run_energies(read_signals(x.validation, 0.0), x.point_of(wrong))) / base_J
            : 0.0;
    return;
  }
}

}  // namespace joulepath
