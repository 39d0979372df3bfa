#include "diagnosis/energies_only/diagnose_energies.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "diagnosis/energies_only/energy_problem.hpp"
#include "diagnosis/energies_only/energy_where.hpp"
#include "diagnosis/evidence/groups.hpp"
#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/numerics/resample.hpp"
#include "diagnosis/thresholds.hpp"
#include "diagnosis/verdict/names.hpp"
#include "model/text_of_list.hpp"

// Design: docs/decisions/0509-energies-alone.md
namespace joulepath {
namespace {

constexpr const char* kLogSome = "candidates only; log speed, voltage and current of some";

std::vector<std::string> limits_of(const EnergyProblem& problem) {
  std::vector<std::string> notes{
      "no run has a log: the motions are taken as prescribed, braking rates and entry speeds as known to " +
          std::to_string(std::lround(100 * kMotionDoubtSigma)) + " %",
      "negative power counts as lost at each wheel but for the robot file's regeneration"};
  if (!problem.hidden.empty()) notes.push_back("not visible in these runs: " + text_of_list(problem.hidden));
  return notes;
}

double sum_of_sizes(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0,
                         [](double sum, double value) { return sum + std::abs(value); });
}

/// The gap on held-out runs; nothing is corrected.
EnergyGap gap_of(const HeldOutEnergies& held_out, const EnergyNoise& repeatability) {
  const double measured_J = sum_of_sizes(held_out.measured_J), gap_J = sum_of_sizes(held_out.before_J),
               signed_J = std::accumulate(held_out.before_J.begin(), held_out.before_J.end(), 0.0);
  EnergyGap gap{.before_percent = 100 * gap_J / measured_J,
                .bias_before_percent = 100 * signed_J / measured_J,
                .noise_floor_percent = noise_floor_percent(repeatability),
                .before_J = gap_J};
  gap.after_percent = gap.before_percent, gap.bias_after_percent = gap.bias_before_percent;
  gap.after_J = gap.before_J;
  return gap;
}

/// A gap that is more than the readings' noise and worth a search.
bool is_left(const EnergyGap& gap, double percent) {
  return percent > std::max(kFloorsLeft * gap.noise_floor_percent, kMaterialGap_percent);
}

/// Whether the candidates shrink the gap of held-out runs: the 95 % interval of the shrink lies above 0.
bool candidates_help(const HeldOutEnergies& held_out, std::size_t bootstrap) {
  const auto shrink_J = [&](const std::vector<std::size_t>& rows) {
    double sum = 0;
    for (std::size_t i : rows) sum += std::abs(held_out.before_J[i]) - std::abs(held_out.after_J[i]);
    return sum;
  };
  return bootstrap_interval(held_out.runs.size(), bootstrap, shrink_J).first > 0;
}

struct Finding {
  Verdict verdict{};
  double left_share{1};  ///< of the held-out gap, beside the candidates
  std::string note{};
};

/// Energies alone do not name a cause: the motion was not recorded, and may cause a part of the gap.
Finding judge_energies(std::size_t runs, const HeldOutEnergies& held_out, const EnergyGap& gap,
                       bool any_candidate, std::size_t bootstrap) {
  if (runs < kRunsForSmallEffects)
    return {Verdict::too_little_data, 1,
            "fewer than " + std::to_string(kRunsForSmallEffects) + " runs: " + kLogSome};
  const Verdict unexplained = is_left(gap, gap.before_percent) ? Verdict::unexplained : Verdict::no_gap;
  if (!any_candidate) return {unexplained};
  const double after_J = sum_of_sizes(held_out.after_J);
  const bool help = candidates_help(held_out, bootstrap);
  char text[160];
  std::snprintf(
      text, sizeof text, "the best candidates turn a gap of %.3g %% on held-out runs into one of %.3g %%: %s",
      gap.before_percent, gap.before_percent * after_J / gap.before_J, help ? kLogSome : "they do not hold");
  if (help) return {Verdict::too_little_data, after_J / gap.before_J, text};
  return {unexplained == Verdict::no_gap ? Verdict::too_little_data : Verdict::unexplained, 1, text};
}

std::vector<std::string> names_of(const EnergyProblem& problem, const std::vector<std::size_t>& runs) {
  std::vector<std::string> names;
  for (std::size_t r : runs) names.push_back(problem.runs[r].name);
  return names;
}

}  // namespace

Diagnosis diagnose_energies(const Dataset& dataset, const DiagnoseOptions& options) {
  const EnergyProblem problem = pose_energy_problem(dataset.robot, energy_runs(dataset), options.without);
  const std::vector<EnergyFold> folds = energy_folds(dataset, problem.runs);
  const bool told = folds.size() == 1 && problem.runs.size() > 1;
  const std::vector<Explanation> explanations =
      explain_energies(problem, told ? folds.front().fitted : every(problem.runs.size()));
  Inclusion inclusion;
  inclusion.add(problem.equations, explanations);
  const HeldOutEnergies held_out = judge_held_out(problem, folds);
  const EnergyGap gap = gap_of(held_out, problem.repeatability);
  const Finding finding = judge_energies(problem.runs.size(), held_out, gap,
                                         !explanations.front().candidates.empty(), options.bootstrap);
  std::vector<std::string> notes = limits_of(problem);
  if (!finding.note.empty()) notes.push_back(finding.note);
  return {
      .gap = {.energy = gap},
      .where = localize_energy_gap(problem.runs, dataset.robot, problem.repeatability, options.bootstrap),
      .verdict = finding.verdict,
      .ranking = rank_effects(inclusion.of_each()),
      .leftover_significant = is_left(gap, finding.left_share * gap.before_percent),
      .leftover_share =
          is_left(gap, finding.left_share * gap.before_percent) ? std::min(1.0, finding.left_share) : 0.0,
      .ceiling_shrink_fraction = gap.before_J > 0 ? 1 - sum_of_sizes(held_out.smooth_J) / gap.before_J : 0.0,
      .missing_channels = {"time series"},
      .notes = notes,
      .validation_runs = names_of(problem, held_out.runs),
      .validation_method = told ? "held-out rows, never used to choose or fit"
                                : "each row in turn, its effects chosen and fitted on the other folds' rows"};
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
                "%zu runs without a log took no part; their energy gap is %.3g %% before the correction and "
                "%.3g %% after it",
                runs.size(), 100 * before_J / measured_J, 100 * after_J / measured_J);
  return text;
}

}  // namespace joulepath
