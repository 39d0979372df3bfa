#include "diagnosis/correction/causes.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/correction/parameters.hpp"
#include "diagnosis/evidence/groups.hpp"
#include "diagnosis/where/gap.hpp"

namespace joulepath {
namespace {

/// Share of the held-out gap that one effect closes without the others.
double shrink_alone(const Examination& x, const ActiveEffect& effect, double base_J) {
  return base_J > 0 ? 1 - absolute_gap_J(judged_energies(x, judged_fit(x, {effect}))) / base_J : 0.0;
}

}  // namespace

Causes report_causes(const Examination& x, const Names& names, const Validation& v, const EnergyGap& gap) {
  Causes report;
  double impact_sum = 0;
  std::vector<double> impacts;
  for (std::size_t e = 0; e < v.judgment.named.size(); ++e) {
    impacts.push_back(
        energy_of_effect_J(v.fitted.signals, x.dataset.robot, x.id.nuisances, v.fitted.state, e));
    impact_sum += impacts.back();
  }
  for (std::size_t e = 0; e < v.judgment.named.size(); ++e) {
    const ActiveEffect& effect = v.fitted.state.effects[e];
    const std::string label = effect.candidate.label();
    Cause cause{.effect = setting_of(effect.candidate, effect.amplitude, x.dataset.robot),
                .probability = probability_of(names, effect),
                .parameters = found_parameters(v.fitted, e, x.dataset.robot),
                .energy_share = impact_sum > 0 ? impacts[e] / impact_sum : 0.0,
                .shrink_fraction_alone = shrink_alone(x, effect, gap.before_J)};
    if (const auto found = names.stand_ins.find(label); found != names.stand_ins.end())
      cause.indistinguishable_from = found->second;
    if (const auto found = names.inseparable.find(label);
        found != names.inseparable.end() && report.pinned_combination.empty())
      report.pinned_combination =
          pinned_combination(x.id.problem, x.id.equations, x.best(), label, found->second, x.id.dispersion);
    report.causes.push_back(std::move(cause));
  }
  if (!report.causes.empty()) report.correlations = parameter_correlations(v.fitted, x.id.nuisances);
  std::ranges::stable_sort(report.causes, std::ranges::greater{}, &Cause::energy_share);
  return report;
}

}  // namespace joulepath
