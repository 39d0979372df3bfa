#include "diagnosis/energies_only/diagnose_energies.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "diagnosis/energies_only/energy_folds.hpp"
#include "diagnosis/energies_only/energy_where.hpp"
#include "diagnosis/evidence/groups.hpp"
#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/numerics/resample.hpp"
#include "diagnosis/thresholds.hpp"
// Design: docs/decisions/0044-energies-alone.md
namespace joulepath {
namespace {

/// One diagnosis of energies under way.
struct EnergyExamination {
  const DiagnoseOptions& options;
  EnergyProblem problem;
  std::vector<EnergyFold> folds{};
  std::vector<Explanation> explanations{};
  std::vector<Candidate> named{};
  Diagnosis report{};
};

std::string listed(const std::set<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

void tell_limits(EnergyExamination& x) {
  std::vector<std::string>& notes = x.report.notes;
  x.report.missing_channels = {"time series"};
  notes.push_back(
      "no run has a log: the motions count as prescribed, with braking rates and entry speeds "
      "known to 20 %");
  notes.push_back("negative power counts as lost at each wheel except for the robot file's regeneration");
  if (!x.problem.hidden.empty()) notes.push_back("not visible in these runs: " + listed(x.problem.hidden));
}

void rank(EnergyExamination& x) {
  for (const auto& [label, probability] : effect_probabilities(x.problem.equations, x.explanations))
    if (probability > kLeastProbabilityRanked) x.report.ranking.push_back({label, probability});
  std::ranges::stable_sort(x.report.ranking, std::ranges::greater{}, &RankedEffect::probability);
  if (x.report.ranking.size() > kLongestRanking) x.report.ranking.resize(kLongestRanking);
}

/// Before and after on held-out rows.
void measure(EnergyExamination& x, const HeldOutGaps& gaps) {
  EnergyGap& energy = x.report.gap.energy;
  double measured_J = 0, bias_before_J = 0, bias_after_J = 0;
  for (std::size_t i = 0; i < gaps.runs.size(); ++i) {
    measured_J += std::abs(gaps.measured_J[i]);
    bias_before_J += gaps.before_J[i], bias_after_J += gaps.after_J[i];
  }
  energy.before_J = gaps.sum_before_J(), energy.after_J = gaps.sum_after_J();
  energy.before_percent = 100 * energy.before_J / measured_J;
  energy.after_percent = 100 * energy.after_J / measured_J;
  energy.bias_before_percent = 100 * bias_before_J / measured_J;
  energy.bias_after_percent = 100 * bias_after_J / measured_J;
  energy.noise_floor_percent = noise_floor_percent(x.problem.repeatability);
  const auto shrink = [&](const std::vector<std::size_t>& rows) {
    double before = 0, after = 0;
    for (std::size_t i : rows) before += std::abs(gaps.before_J[i]), after += std::abs(gaps.after_J[i]);
    return before > 0 ? 1 - after / before : 0.0;
  };
  energy.shrink_fraction = shrink(every(gaps.runs.size()));
  energy.shrink_interval_95 = bootstrap_interval(gaps.runs.size(), x.options.bootstrap, shrink);
}

double shrink_fraction(const HeldOutGaps& gaps) {
  return gaps.sum_before_J() > 0 ? 1 - gaps.sum_after_J() / gaps.sum_before_J() : 0.0;
}

bool is_left(const EnergyGap& energy, double percent) {
  return percent > std::max(kFloorsLeft * energy.noise_floor_percent, kMaterialGap_percent);
}

/// Nothing is corrected; the candidates stay in the ranking.
void correct_nothing(EnergyGap& energy) {
  energy.after_J = energy.before_J, energy.after_percent = energy.before_percent;
  energy.bias_after_percent = energy.bias_before_percent;
  energy.shrink_fraction = 0, energy.shrink_interval_95 = {};
}

void withdraw(EnergyExamination& x) {
  EnergyGap& energy = x.report.gap.energy;
  char text[160];
  std::snprintf(text, sizeof text,
                "the best explanation turns a gap of %.3g %% on held-out rows into one of %.3g %% and was "
                "withdrawn",
                energy.before_percent, energy.after_percent);
  x.report.notes.emplace_back(text);
  x.report.verdict = is_left(energy, energy.before_percent) ? Verdict::unexplained : Verdict::too_little_data;
}

/// Names are withdrawn if chance or the robot file itself explains the gap as well.
void judge(EnergyExamination& x) {
  EnergyGap& energy = x.report.gap.energy;
  const std::vector<int>& best = x.explanations.front().candidates;
  if (x.problem.runs.size() < kRunsForSmallEffects) {
    x.report.verdict = Verdict::too_little_data;
    x.report.notes.push_back("fewer than " + std::to_string(kRunsForSmallEffects) +
                             " runs: candidates only; log speed, voltage and current of some");
    return;
  }
  if (best.empty()) {
    x.report.verdict = is_left(energy, energy.before_percent) ? Verdict::unexplained : Verdict::no_gap;
    return;
  }
  if (energy.shrink_interval_95.first <= 0) {
    withdraw(x);
    return;
  }
  x.named = candidates_of(x.problem, x.explanations.front());
  x.report.verdict = Verdict::explained;  // or less, as report_causes() finds
}

std::vector<FoundParameter> parameters_of(const EnergyFit& fit, std::size_t e, const Robot& robot) {
  const ActiveEffect& effect = fit.state.effects[e];
  const EffectSetting setting = setting_of(effect.candidate, effect.amplitude, robot);
  const auto at = [&](double amplitude) {
    return setting_of(effect.candidate, {amplitude}, robot).parameters.at(effect.candidate.amplitude[0]);
  };
  std::vector<FoundParameter> found;
  for (const auto& [name, value] : setting.parameters) {
    FoundParameter parameter{.name = name, .value = value, .interval_95 = {value, value}};
    if (name == effect.candidate.amplitude[0]) {
      const double a = effect.amplitude[0], width = 1.96 * fit.sd[e][0];
      parameter.interval_95 = std::minmax({at(a - width), at(a + width)});
    }
    found.push_back(parameter);
  }
  return found;
}

void report_causes(EnergyExamination& x) {
  const auto probabilities = effect_probabilities(x.problem.equations, x.explanations);
  const std::vector<std::size_t> all = every(x.problem.runs.size());
  const EnergyFit fit = fit_energies(x.problem, all, x.named);
  const Explanation& best = x.explanations.front();
  // The motion was not recorded: it may cause the leftover, and also the explained part.
  const EnergyGap& energy = x.report.gap.energy;
  const double left = is_left(energy, energy.after_percent) ? energy.after_J / energy.before_J : 0.0;
  bool sure = left == 0;
  double changes_J = 0;
  for (std::size_t e = 0; e < x.named.size(); ++e) {
    const std::string label = x.named[e].label();
    Cause cause{
        .effect = setting_of(x.named[e], fit.state.effects[e].amplitude, x.problem.robot),
        .probability = (1 - left) * std::min(kSurestOfEnergies, probabilities.at(label)),
        .indistinguishable_from = stand_ins_by_score(x.problem.equations, x.explanations, best.candidates[e]),
        .parameters = parameters_of(fit, e, x.problem.robot)};
    if (!cause.indistinguishable_from.empty() && x.report.pinned_combination.empty())
      x.report.pinned_combination =
          pinned_combination(without_calibration(x.problem.equations, all), x.problem.equations, best, label,
                             cause.indistinguishable_from.front(), 1.0);
    sure = sure && cause.probability >= kSureOfEnergies && cause.indistinguishable_from.empty();
    EnergyFit without = fit;
    without.state.effects.erase(without.state.effects.begin() + static_cast<std::ptrdiff_t>(e));
    cause.energy_share =
        (energy_gaps_J(x.problem, fit, all) - energy_gaps_J(x.problem, without, all)).cwiseAbs().sum();
    changes_J += cause.energy_share;
    cause.shrink_fraction_alone = shrink_fraction(held_out_gaps(x.problem, x.folds, {x.named[e]}));
    x.report.causes.push_back(std::move(cause));
  }
  for (Cause& cause : x.report.causes) cause.energy_share /= std::max(1e-9, changes_J);
  if (!sure) x.report.verdict = Verdict::ambiguous;
  if (sure) {
    x.report.corrected_robot = x.problem.robot;
    for (const EffectSetting& setting : settings_of(x.problem.robot, fit.state))
      (is_instrument(setting.name) ? x.report.corrected_instruments : x.report.corrected_robot->effects)
          .push_back(setting);
  }
}

/// References for the shrink: any smooth function of the circumstances, and a wrong candidate.
void report_controls(EnergyExamination& x) {
  x.report.ceiling_shrink_fraction = shrink_fraction(smooth_held_out_gaps(x.problem, x.folds));
  std::set<std::string> spoken_for;
  for (const Cause& cause : x.report.causes)
    spoken_for.insert(cause.indistinguishable_from.begin(), cause.indistinguishable_from.end());
  for (const Candidate& candidate : x.named) spoken_for.insert(candidate.label());
  for (const Explanation& e : x.explanations) {
    if (x.named.empty() || e.candidates.size() != 1) continue;
    const Candidate& candidate =
        x.problem.equations.candidates[static_cast<std::size_t>(e.candidates.front())];
    if (spoken_for.contains(candidate.label())) continue;
    x.report.control_effect = candidate.label();
    x.report.control_shrink_fraction = shrink_fraction(held_out_gaps(x.problem, x.folds, {candidate}));
    return;
  }
}

void describe_leftover(EnergyExamination& x) {
  const EnergyGap& energy = x.report.gap.energy;
  if (!is_left(energy, energy.after_percent)) return;
  x.report.leftover_significant = true;
  x.report.leftover_share = energy.before_J > 0 ? std::min(1.0, energy.after_J / energy.before_J) : 0.0;
  x.report.leftover_description = "depends on";
  const char* separator = " ";
  for (const char* axis : {"path", "payload", "acceleration"}) {
    const auto cells = std::ranges::count(x.report.where, axis, &WhereCell::axis);
    if (cells > 1) x.report.leftover_description += separator + std::string(axis), separator = ", ";
  }
}

}  // namespace

Diagnosis diagnose_energies(const Dataset& dataset, const DiagnoseOptions& options) {
  EnergyExamination x{.options = options,
                      .problem = pose_energy_problem(dataset.robot, energy_runs(dataset), options.without)};
  tell_limits(x);
  x.report.where =
      localize_energy_gap(x.problem.runs, dataset.robot, x.problem.repeatability, options.bootstrap);
  x.folds = energy_folds(dataset, x.problem.runs);
  x.explanations =
      explain_energies(x.problem, x.folds.size() == 1 && x.problem.runs.size() >= kRunsForSmallEffects
                                      ? x.folds.front().fitted
                                      : every(x.problem.runs.size()));
  rank(x);
  const HeldOutGaps gaps = held_out_gaps(x.problem, x.folds);
  measure(x, gaps);
  for (std::size_t r : gaps.runs) x.report.validation_runs.push_back(x.problem.runs[r].name);
  x.report.validation_method = x.folds.size() == 1
                                   ? "held-out rows, never used to choose or fit"
                                   : "each row once, with effects chosen and fitted on the other folds";
  judge(x);
  if (x.named.empty())
    correct_nothing(x.report.gap.energy);
  else
    report_causes(x);
  describe_leftover(x);
  report_controls(x);
  return std::move(x.report);
}

std::string told_by_energies(const Dataset& dataset, const Correction& correction) {
  const std::vector<EnergyRun> runs = energy_runs(dataset);
  if (runs.empty()) return {};
  const ModelPoint nominal{.robot = dataset.robot},
      corrected{.robot = correction.robot.value_or(dataset.robot), .effects = correction.instruments};
  double measured_J = 0, before_J = 0, after_J = 0;
  for (const EnergyRun& run : runs) {
    measured_J += std::abs(run.measured_J());
    before_J += std::abs(run.of(joules_of(run.motion, nominal)) - run.measured_J());
    after_J += std::abs(run.of(joules_of(run.motion, corrected)) - run.measured_J());
  }
  char text[200];
  std::snprintf(text, sizeof text,
                "%zu runs without a log were held out; their energy gap is %.3g %% before the correction and "
                "%.3g %% after it",
                runs.size(), 100 * before_J / measured_J, 100 * after_J / measured_J);
  return text;
}

}  // namespace joulepath
