#include "diagnosis/energies_only/energy_problem.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "diagnosis/evidence/signatures.hpp"
#include "diagnosis/numerics/folds.hpp"
#include "diagnosis/numerics/parallel.hpp"
#include "diagnosis/thresholds.hpp"
#include "model/effects/catalog.hpp"

namespace joulepath {
namespace {

constexpr int kNoiseRounds = 4;

/// Effects that show only in the samples of a log, or in the time of day where the runs do not state it.
std::set<std::string> beyond_energies(const std::vector<EnergyRun>& runs) {
  const bool dated =
      std::ranges::all_of(runs, [](const EnergyRun& run) { return run.motion.signals.time_of_day_known; });
  std::set<std::string> names;
  for (const EffectDescription& effect : effect_catalog())
    if (effect.info.needs.samples || (effect.info.needs.time_of_day && !dated))
      names.emplace(effect.info.name);
  return names;
}

/// Columns: nuisances, doubts about the motions, amplitudes of the candidates.
std::vector<Column> columns_of(const std::vector<Nuisance>& nuisances, const ModelState& nominal,
                               const std::vector<Candidate>& candidates) {
  std::vector<Column> columns = list_columns(nuisances, nominal, candidates, 0, Forms::none);
  const auto count = static_cast<int>(nuisances.size());
  for (int k = 0; k < static_cast<int>(kMotionDoubts.size()); ++k)
    columns.insert(columns.begin() + count + k, {Column::Kind::nuisance, count + k, 0, 1.0, 0.0});
  return columns;
}

/// Change of a run's energies (J) with each column, and measured minus predicted energies.
Eigen::MatrixXd rows_of(const EnergyRun& run, const Robot& robot, const std::vector<Nuisance>& nuisances,
                        const ModelState& nominal, const Equations& equations) {
  const auto at = [&](const DrivenMotion& motion, const ModelState& state) {
    return energy_rows(run, joules_of(motion, model_point(robot, nuisances, state)));
  };
  const auto slope = [&](const Column& column) -> Eigen::VectorXd {
    const auto owner = static_cast<std::size_t>(column.owner), part = static_cast<std::size_t>(column.part);
    if (column.kind == Column::Kind::nuisance && owner >= nuisances.size()) {
      const auto& [less, more] = run.doubted[owner - nuisances.size()];
      return 0.5 * (at(more, nominal) - at(less, nominal));
    }
    if (column.kind == Column::Kind::nuisance) {
      ModelState less = nominal, more = nominal;
      less.nuisance_fraction[owner] -= nuisances[owner].sigma;
      more.nuisance_fraction[owner] += nuisances[owner].sigma;
      return (at(run.motion, more) - at(run.motion, less)) / (2 * nuisances[owner].sigma);
    }
    const Candidate& candidate = equations.candidates[owner];
    const AmplitudeStep step = amplitude_step(nominal, candidate, part);
    const auto changed = [&](double change) {
      return at(run.motion, with_change(nominal, candidate, step, part, change));
    };
    return (changed(step.high) - changed(step.low)) / (step.high - step.low);
  };
  const Eigen::VectorXd measured = measured_rows(run);
  Eigen::MatrixXd rows(measured.size(), std::ssize(equations.columns) + 1);
  for (std::size_t k = 0; k < equations.columns.size(); ++k)
    rows.col(static_cast<Eigen::Index>(k)) = slope(equations.columns[k]);
  rows.rightCols(1) = measured - at(run.motion, nominal);
  return rows;
}

/// Divides the rows of each run by their scatter.
void weigh(EnergyProblem& problem) {
  problem.equations.runs.resize(problem.runs.size());
  for (std::size_t r = 0; r < problem.runs.size(); ++r) {
    const double joules = std::abs(problem.runs[r].measured_J());
    Eigen::MatrixXd rows = problem.rows_J[r];
    rows.row(0) /= joules * problem.noise.sum;
    if (rows.rows() > 1) rows.row(1) /= joules * problem.noise.difference;
    problem.equations.runs[r].gram = rows.transpose() * rows;
  }
}

void find_visible(EnergyProblem& problem) {
  const Equations& equations = problem.equations;
  const LinearProblem rest = without_calibration(equations, every(problem.runs.size()));
  std::set<std::string> seen;
  for (std::size_t c = 0; c < equations.candidates.size(); ++c) {
    double sigmas = 0;
    for (int k : equations.columns_of_candidate(static_cast<int>(c), false))
      sigmas = std::max(sigmas, std::sqrt(std::max(0.0, rest.gram(k, k))) * rest.prior_sd[k]);
    const std::string label = equations.candidates[c].label();
    if (sigmas > kVisibleSigmas)
      problem.visible.push_back(static_cast<int>(c)), seen.insert(label);
    else
      problem.hidden.insert(label);
  }
  for (const std::string& label : seen) problem.hidden.erase(label);
}

/// Amplitude of each candidate that changes the energy of the runs by the materiality floor.
std::vector<double> material_amplitudes(const EnergyProblem& problem) {
  const Equations& equations = problem.equations;
  const LinearProblem all = sum_runs(equations.runs, every(problem.runs.size()), equations.prior_sd);
  std::vector<double> least;
  for (std::size_t c = 0; c < equations.candidates.size(); ++c) {
    const int k = equations.columns_of_candidate(static_cast<int>(c), false).front();
    const double per_amplitude =
        problem.noise.sum * std::sqrt(all.gram(k, k) / static_cast<double>(problem.runs.size()));
    least.push_back(per_amplitude > 0 ? kMaterialEnergy / per_amplitude : 1e300);
  }
  return least;
}

/// An explanation and the calibration, fitted to some runs.
struct EnergyFit {
  ModelState state{};
  Eigen::VectorXd doubts{};  ///< doubts about the motions, in sigmas
};

EnergyFit fit_energies(const EnergyProblem& problem, const std::vector<std::size_t>& which,
                       const Explanation& explanation) {
  const Eigen::VectorXd parameters = fit_parameters(problem.equations, which, explanation.columns, 1.0);
  const Eigen::Index nuisances = std::ssize(problem.nuisances);
  EnergyFit fit{.state = {.nuisance_fraction = {parameters.begin(), parameters.begin() + nuisances}},
                .doubts = parameters.segment(nuisances, std::ssize(kMotionDoubts))};
  for (int c : explanation.candidates) {
    ActiveEffect effect{.candidate = problem.equations.candidates[static_cast<std::size_t>(c)]};
    for (int k : problem.equations.columns_of_candidate(c, false)) effect.amplitude.push_back(parameters[k]);
    fit.state.effects.push_back(std::move(effect));
  }
  return fit;
}

/// Predicted minus measured rows (J) of a run: a full prediction, linear in the doubts about its motion.
Eigen::VectorXd row_gaps_J(const EnergyProblem& problem, std::size_t r, const EnergyFit& fit) {
  const EnergyRun& run = problem.runs[r];
  const ModelPoint point = model_point(problem.robot, problem.nuisances, fit.state);
  return energy_rows(run, joules_of(run.motion, point)) - measured_rows(run) +
         problem.rows_J[r].middleCols(std::ssize(problem.nuisances), fit.doubts.size()) * fit.doubts;
}

/// Root mean square residual of one row over the runs that have it, relative to the energy of the run.
double left_over(const EnergyProblem& problem, const EnergyFit& fit, Eigen::Index row) {
  double square = 0, freedom = -static_cast<double>(fit.state.effects.size()) - 1;
  for (std::size_t r = 0; r < problem.runs.size(); ++r) {
    const Eigen::VectorXd gap_J = row_gaps_J(problem, r, fit);
    if (row >= gap_J.size()) continue;
    square += std::pow(gap_J[row] / problem.runs[r].measured_J(), 2), freedom += 1;
  }
  return freedom > 0 ? std::sqrt(square / freedom) : 0.0;
}

/// Increases the scatter until the best candidates fit as well as it implies: their residual is a model
/// error, not noise of the readings.
void add_model_error(EnergyProblem& problem) {
  const std::vector<std::size_t> all = every(problem.runs.size());
  for (int round = 0; round < kNoiseRounds; ++round) {
    const Explanation best = explain_energies(problem, all).front();
    if (best.candidates.empty()) return;
    const EnergyFit fit = fit_energies(problem, all, best);
    problem.noise.sum = std::max(problem.noise.sum, left_over(problem, fit, 0));
    problem.noise.difference = std::max(problem.noise.difference, left_over(problem, fit, 1));
    weigh(problem);
  }
}

}  // namespace

EnergyProblem pose_energy_problem(const Robot& robot, std::vector<EnergyRun> runs,
                                  const std::set<std::string>& without) {
  EnergyProblem problem{.robot = robot, .runs = std::move(runs), .nuisances = nuisances_of(robot)};
  const std::vector<Nuisance>& nuisances = problem.nuisances;
  const ModelState nominal{.nuisance_fraction = std::vector<double>(nuisances.size(), 0.0)};
  std::set<std::string> left_out = problem.hidden = beyond_energies(problem.runs);
  left_out.insert(without.begin(), without.end());
  Equations& equations = problem.equations;
  equations.candidates = catalog_candidates(robot, left_out);
  equations.columns = columns_of(nuisances, nominal, equations.candidates);
  equations.prior_sd.resize(std::ssize(equations.columns));
  for (std::size_t k = 0; k < equations.columns.size(); ++k)
    equations.prior_sd[static_cast<Eigen::Index>(k)] = equations.columns[k].prior_sd;
  problem.rows_J.resize(problem.runs.size());
  parallel_for(problem.runs.size(), [&](std::size_t r) {
    problem.rows_J[r] = rows_of(problem.runs[r], robot, nuisances, nominal, equations);
  });
  problem.noise = problem.repeatability = estimate_energy_noise(problem.runs, robot);
  weigh(problem);
  find_visible(problem);
  add_model_error(problem);
  return problem;
}

std::vector<Explanation> explain_energies(const EnergyProblem& problem,
                                          const std::vector<std::size_t>& which) {
  std::vector<Explanation> explanations =
      search_explanations(without_calibration(problem.equations, which), problem.equations,
                          {.most_effects = problem.visible.empty() ? 0 : kMostEffectsOfEnergies,
                           .allowed = problem.visible,
                           .least_amplitude = material_amplitudes(problem)});
  std::erase_if(explanations, [](const Explanation& e) { return !e.small.empty(); });
  return explanations;
}

std::vector<EnergyFold> energy_folds(const Dataset& dataset, const std::vector<EnergyRun>& runs) {
  std::vector<std::tuple<std::string, double, double, double>> keys;
  std::vector<std::size_t> told;
  for (const EnergyRun& run : runs) {
    keys.emplace_back(run.path, run.payload_kg, run.acceleration_m_s2, run.measured_J());
    told.push_back(dataset.runs[run.run_index].use == RunUse::validation ? 0 : 1);
  }
  const bool is_told = std::ranges::count(told, std::size_t{0}) > 0;
  std::vector<EnergyFold> folds(is_told ? 1 : std::min(kEnergyFolds, runs.size()));
  const std::vector<std::size_t> fold_of = is_told ? told : dealt_folds(keys, folds.size());
  for (std::size_t r = 0; r < runs.size(); ++r)
    for (std::size_t f = 0; f < folds.size(); ++f)
      (fold_of[r] == f ? folds[f].judged : folds[f].fitted).push_back(r);
  return folds;
}

HeldOutEnergies judge_held_out(const EnergyProblem& problem, const std::vector<EnergyFold>& folds) {
  HeldOutEnergies held_out;
  for (const EnergyFold& fold : folds) {
    const Explanation best = explain_energies(problem, fold.fitted).front();
    const EnergyFit fit = fit_energies(problem, fold.fitted, best);
    const Eigen::VectorXd error = smooth_error(problem.runs, fold.fitted, fold.judged, problem.robot);
    for (std::size_t k = 0; k < fold.judged.size(); ++k) {
      const std::size_t r = fold.judged[k];
      const double measured_J = problem.runs[r].measured_J(), before_J = -problem.rows_J[r].rightCols(1)(0);
      held_out.runs.push_back(r);
      held_out.measured_J.push_back(std::abs(measured_J));
      held_out.before_J.push_back(before_J);
      held_out.after_J.push_back(row_gaps_J(problem, r, fit)[0]);
      held_out.smooth_J.push_back(before_J - error[static_cast<Eigen::Index>(k)] * std::abs(measured_J));
    }
  }
  return held_out;
}

}  // namespace joulepath
