#include "diagnosis/evidence/refit.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/evidence/run_covariance.hpp"
#include "diagnosis/thresholds.hpp"

namespace joulepath {
namespace {

constexpr double kRegionEdgeStep_m = 0.2;  ///< that an edge moves by in one iteration

double clamp_shape(const Candidate& candidate, const std::string& name, double old_value, double value) {
  const ParameterDescription& parameter = *candidate.effect().find(name);
  value = std::clamp(value, parameter.min, parameter.max);
  if (parameter.role == ParameterRole::edge)
    return std::clamp(value, old_value - kRegionEdgeStep_m, old_value + kRegionEdgeStep_m);
  if (old_value > 0) value = std::clamp(value, 0.5 * old_value, 2.0 * old_value);
  return value;
}

/// Some stay a column of the linear problem.
void set_nuisance(ModelState& state, const std::vector<Nuisance>& nuisances, std::size_t index,
                  double value) {
  if (!is_column_only(nuisances[index])) state.nuisance_fraction[index] = value;
}

/// Moves the state to the parameters that the linear problem about it gives.
ModelState moved(const Equations& equations, const std::vector<Nuisance>& nuisances, ModelState state,
                 const Eigen::VectorXd& parameters) {
  for (std::size_t k = 0; k < equations.columns.size(); ++k) {
    const Column& column = equations.columns[k];
    const double value = parameters[static_cast<Eigen::Index>(k)];
    const auto owner = static_cast<std::size_t>(column.owner), part = static_cast<std::size_t>(column.part);
    if (column.kind == Column::Kind::nuisance) set_nuisance(state, nuisances, owner, value);
    if (column.kind == Column::Kind::nuisance || owner >= state.effects.size()) continue;
    ActiveEffect& effect = state.effects[owner];
    if (column.kind == Column::Kind::amplitude)
      effect.amplitude[part] = effect.candidate.nonnegative ? std::max(0.0, value) : value;
    if (column.kind == Column::Kind::shape) {
      const std::string name = shape_parameters(effect.candidate.shape.name)[part];
      double& shape = effect.candidate.shape.parameters[name];
      shape = clamp_shape(effect.candidate, name, shape, shape + value);
    }
  }
  return state;
}

/// What a column stands for, at a state. Unknown terms and time stamps stay columns: 0.
double value_at(const ModelState& state, const Column& column) {
  const auto owner = static_cast<std::size_t>(column.owner), part = static_cast<std::size_t>(column.part);
  if (column.kind == Column::Kind::nuisance) return state.nuisance_fraction[owner];
  if (column.kind == Column::Kind::amplitude) return state.effects[owner].amplitude[part];
  if (column.kind != Column::Kind::shape) return 0.0;
  const Candidate& candidate = state.effects[owner].candidate;
  return candidate.shape.parameters.at(shape_parameters(candidate.shape.name)[part]);
}

bool moves_in_steps(const ModelState& state, const Column& column) {
  if (column.kind != Column::Kind::shape) return false;
  const Candidate& candidate = state.effects[static_cast<std::size_t>(column.owner)].candidate;
  const std::string name = shape_parameters(candidate.shape.name)[static_cast<std::size_t>(column.part)];
  return candidate.effect().find(name)->role == ParameterRole::edge;
}

/// Whether a fit is at its end. Edges move in steps past the samples: what they change shows in the strength.
bool hardly_moves(const Refit& fit, const ModelState& from, const ModelState& to) {
  for (std::size_t i = 0; i < fit.columns.size(); ++i) {
    const Column& column = fit.equations.columns[static_cast<std::size_t>(fit.columns[i])];
    const auto at = static_cast<Eigen::Index>(i);
    const double least = kConvergedStep * std::sqrt(fit.covariance(at, at));
    if (!moves_in_steps(from, column) && std::abs(value_at(to, column) - value_at(from, column)) > least)
      return false;
  }
  return true;
}

}  // namespace

ModelState adopt(const Equations& equations, const std::vector<Nuisance>& nuisances, const ModelState& state,
                 const Explanation& explanation, const Eigen::VectorXd& parameters) {
  ModelState next{.nuisance_fraction = state.nuisance_fraction};
  for (std::size_t k = 0; k < equations.columns.size(); ++k)
    if (equations.columns[k].kind == Column::Kind::nuisance)
      set_nuisance(next, nuisances, static_cast<std::size_t>(equations.columns[k].owner),
                   parameters[static_cast<Eigen::Index>(k)]);
  for (int c : explanation.candidates) {
    ActiveEffect effect{.candidate = equations.candidates[static_cast<std::size_t>(c)]};
    for (int k : equations.columns_of_candidate(c, false)) effect.amplitude.push_back(parameters[k]);
    for (int k : equations.columns_of_candidate(c, true)) {
      const Column& column = equations.columns[static_cast<std::size_t>(k)];
      if (column.kind != Column::Kind::shape) continue;
      const std::string name =
          shape_parameters(effect.candidate.shape.name)[static_cast<std::size_t>(column.part)];
      double& shape = effect.candidate.shape.parameters[name];
      shape = clamp_shape(effect.candidate, name, shape, shape + parameters[k]);
    }
    next.effects.push_back(effect);
  }
  return next;
}

Refit refit(const LogSet& logs, const std::vector<std::size_t>& fit_runs,
            const std::vector<Nuisance>& nuisances, ModelState state, const NoiseModel& noise,
            const Eigen::VectorXd& run_variance, double dispersion, const std::set<std::string>& unknowns) {
  Refit result;
  EquationOptions options{.whole_catalog = false,
                          .dictionary = false,
                          .forms = Forms::none,
                          .unknowns = unknowns,
                          .noise = &noise,
                          .run_variance = &run_variance};
  double read_delay_s = std::nan("");
  for (int step = 0;; ++step) {
    if (channel_delay_s(state) != read_delay_s) {
      read_delay_s = channel_delay_s(state);
      result.signals = read_signals(logs, read_delay_s);
    }
    result.equations = build_equations(result.signals, logs.dataset->robot, nuisances, state, {}, options);
    result.columns = result.equations.columns_of(Column::Kind::nuisance);
    std::vector<int> effect_columns;
    for (std::size_t c = 0; c < state.effects.size(); ++c)
      for (int k : result.equations.columns_of_candidate(static_cast<int>(c), true))
        effect_columns.push_back(k);
    for (int k : result.equations.columns_of(Column::Kind::dictionary)) effect_columns.push_back(k);
    result.columns.insert(result.columns.end(), effect_columns.begin(), effect_columns.end());
    result.parameters =
        fit_parameters(result.equations, fit_runs, effect_columns, dispersion, &result.covariance);
    ModelState next = moved(result.equations, nuisances, state, result.parameters);
    if (step == kMostFitSteps || hardly_moves(result, state, next)) break;
    state = std::move(next);
  }
  result.state = state;
  result.dispersion = dispersion;
  result.fit_runs = fit_runs.size();
  result.run_covariance = run_covariance(result.equations, fit_runs, result.columns, result.parameters,
                                         result.covariance, dispersion);
  return result;
}

ModelState state_of_runs(const Refit& fitted, const std::vector<Nuisance>& nuisances,
                         const std::vector<std::size_t>& runs) {
  const LinearProblem problem = sum_runs(fitted.equations.runs, runs, fitted.equations.prior_sd);
  return moved(fitted.equations, nuisances, fitted.state,
               fit_parameters(problem, fitted.columns, fitted.dispersion));
}

}  // namespace joulepath
