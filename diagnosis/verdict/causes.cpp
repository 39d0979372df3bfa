#include "diagnosis/verdict/causes.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/evidence/groups.hpp"
#include "diagnosis/evidence/held_out.hpp"
#include "diagnosis/verdict/parameters.hpp"
#include "diagnosis/where/gap.hpp"

namespace joulepath {
namespace {

/// Fills in what could stand in for a named effect, and the combination that the data pin all the same.
void report_stand_ins(Examination& x, const std::string& label, Cause& cause) {
  const Identification& id = x.id;
  const Explanation& best = id.explanations.front();
  for (int c : best.candidates) {
    if (id.equations.candidates[static_cast<std::size_t>(c)].label() != label) continue;
    const auto found = x.stand_ins.find(label);
    if (found == x.stand_ins.end()) continue;
    cause.indistinguishable_from = found->second;
    if (!x.report.pinned_combination.empty()) continue;
    x.report.pinned_combination = pinned_combination(id.problem, id.equations, best, label,
                                                     cause.indistinguishable_from.front(), id.dispersion);
  }
}

/// Share of the held-out gap that one effect closes without the others.
double shrink_alone(const Examination& x, const ActiveEffect& effect) {
  const double base_J = x.report.gap.energy.before_J;
  const ModelState alone = refit_on_diagnosis(x.diagnosis, x.id, {effect});
  const std::vector<RunSignals> signals = read_signals(x.validation, channel_delay_s(alone));
  return base_J > 0 ? 1 - absolute_gap_J(run_energies(signals, x.point_of(alone))) / base_J : 0.0;
}

}  // namespace

void report_causes(Examination& x, const Correction& correction) {
  double impact_sum = 0;
  std::vector<double> impacts;
  for (std::size_t e = 0; e < x.named.size(); ++e) {
    impacts.push_back(
        energy_of_effect(correction.fitted.signals, x.dataset.robot, x.id.nuisances, correction.state, e)
            .effect_J);
    impact_sum += impacts.back();
  }
  for (std::size_t e = 0; e < x.named.size(); ++e) {
    const ActiveEffect& effect = correction.state.effects[e];
    Cause cause{.effect = setting_of(effect.candidate, effect.amplitude, x.dataset.robot),
                .probability = x.probability_of(effect),
                .energy_share = impact_sum > 0 ? impacts[e] / impact_sum : 0.0};
    report_stand_ins(x, effect.candidate.label(), cause);
    cause.parameters = found_parameters(correction.fitted, e, x.dataset.robot);
    cause.shrink_fraction_alone = shrink_alone(x, effect);
    x.report.causes.push_back(std::move(cause));
  }
  std::stable_sort(x.report.causes.begin(), x.report.causes.end(),
                   [](const Cause& a, const Cause& b) { return a.energy_share > b.energy_share; });
}

}  // namespace joulepath
