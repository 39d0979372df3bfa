#include "diagnosis/correction/parameters.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "diagnosis/thresholds.hpp"

namespace joulepath {
namespace {

/// Rows of the refit's covariance that belong to a parameter of an effect.
std::vector<Eigen::Index> covariance_rows(const Refit& fitted, std::size_t effect, const std::string& name) {
  std::vector<Eigen::Index> rows;
  const std::vector<std::string> shapes = shape_parameters(fitted.state.effects[effect].candidate.shape.name);
  for (std::size_t i = 0; i < fitted.columns.size(); ++i) {
    const Column& column = fitted.equations.columns[static_cast<std::size_t>(fitted.columns[i])];
    if (column.kind == Column::Kind::nuisance || column.owner != static_cast<int>(effect)) continue;
    const bool shape =
        column.kind == Column::Kind::shape && shapes[static_cast<std::size_t>(column.part)] == name;
    const bool amplitude = column.kind == Column::Kind::amplitude &&
                           std::find(shapes.begin(), shapes.end(), name) == shapes.end();
    if (shape || amplitude) rows.push_back(static_cast<Eigen::Index>(i));
  }
  return rows;
}

/// Standard deviation along a gradient over some parameters: the greater of what the noise model and the
/// runs' differences say.
double sd_along(const Refit& fitted, const std::vector<Eigen::Index>& rows,
                const std::vector<double>& gradient) {
  double greatest = 0;
  for (const Eigen::MatrixXd* covariance : {&fitted.covariance, &fitted.run_covariance}) {
    double variance = 0;
    for (std::size_t i = 0; i < gradient.size(); ++i)
      for (std::size_t j = 0; j < gradient.size(); ++j)
        variance += gradient[i] * gradient[j] * (*covariance)(rows[i], rows[j]);
    greatest = std::max(greatest, variance);
  }
  return std::sqrt(greatest);
}

/// Size or direction of a vector, as a gradient over its components.
std::vector<double> polar_gradient(const ActiveEffect& vector, bool direction) {
  const double x = vector.amplitude[0], y = vector.amplitude[1], size = std::max(1e-9, std::hypot(x, y));
  if (direction) return {-y / (size * size), x / (size * size)};
  return {x / size, y / size};
}

/// A law's strength averages over what its form leaves out; a constant or an instrument has no form.
double form_sd(const ActiveEffect& active, const std::string& name) {
  const EffectDescription& description = active.candidate.effect();
  const Stage stage = description.info.stage;
  if (stage == Stage::parameters || stage == Stage::instrument || stage == Stage::supply) return 0.0;
  if (name != description.strength().name) return 0.0;
  double square = 0;
  for (double amplitude : active.amplitude) square += amplitude * amplitude;
  return kLawInexactness * std::sqrt(square);
}

double degrees_of(const Refit& fitted) { return std::max(1.0, static_cast<double>(fitted.fit_runs) - 1); }

/// Half a 95 % interval, for the number of runs that it rests on.
double half_interval(const Refit& fitted, std::size_t effect, const std::string& name) {
  const ActiveEffect& active = fitted.state.effects[effect];
  const std::vector<Eigen::Index> rows = covariance_rows(fitted, effect, name);
  const EffectDescription& effect_of = active.candidate.effect();
  const std::vector<double> gradient = effect_of.find(ParameterRole::direction)
                                           ? polar_gradient(active, name != effect_of.strength().name)
                                           : std::vector<double>{1.0};
  const double sd = rows.size() < gradient.size() ? 0.5 * kRegionStep_m : sd_along(fitted, rows, gradient);
  return std::hypot(sd, form_sd(active, name)) *
         boost::math::quantile(boost::math::students_t(degrees_of(fitted)), 0.975);
}

const Column& column_of(const Refit& fitted, Eigen::Index row) {
  return fitted.equations.columns[static_cast<std::size_t>(fitted.columns[static_cast<std::size_t>(row)])];
}

/// An effect and its parameter, or "friction_torque_Nm (left)".
std::string name_of(const Refit& fitted, const std::vector<Nuisance>& nuisances, const Column& column) {
  const auto owner = static_cast<std::size_t>(column.owner);
  if (column.kind == Column::Kind::nuisance) return text_of(nuisances[owner]);
  const Candidate& candidate = fitted.state.effects[owner].candidate;
  return candidate.label() + " " + candidate.amplitude[static_cast<std::size_t>(column.part)];
}

}  // namespace

std::vector<FoundParameter> found_parameters(const Refit& fitted, std::size_t effect, const Robot& robot) {
  const ActiveEffect& active = fitted.state.effects[effect];
  const EffectSetting setting = setting_of(active.candidate, active.amplitude, robot);
  std::vector<FoundParameter> found;
  for (const ParameterDescription& parameter : active.candidate.effect().parameters) {
    const auto at = setting.parameters.find(parameter.name);
    if (at == setting.parameters.end()) continue;
    const double half = half_interval(fitted, effect, parameter.name);
    Range95 interval{at->second - half, at->second + half};
    if (parameter.role == ParameterRole::inverse_strength) {  // symmetric in the strength
      const double strength = 1 / at->second;
      interval = {1 / (strength + half), 1 / std::max(1e-9, strength - half)};
    }
    found.push_back({parameter.name, at->second, interval});
  }
  return found;
}

std::vector<ParameterCorrelation> parameter_correlations(const Refit& fitted,
                                                         const std::vector<Nuisance>& nuisances) {
  std::vector<ParameterCorrelation> found;
  const Eigen::MatrixXd& covariance = fitted.covariance;
  for (Eigen::Index i = 0; i < covariance.rows(); ++i)
    for (Eigen::Index j = 0; j < i; ++j) {
      const Column &one = column_of(fitted, i), &other = column_of(fitted, j);
      const bool two_effects = other.kind == Column::Kind::amplitude && other.owner != one.owner;
      if (one.kind != Column::Kind::amplitude || (!two_effects && other.kind != Column::Kind::nuisance))
        continue;
      const double square = covariance(i, i) * covariance(j, j);
      const double correlation = square > 0 ? covariance(i, j) / std::sqrt(square) : 0.0;
      if (std::abs(correlation) < kNotableCorrelation) continue;
      found.push_back({name_of(fitted, nuisances, one), name_of(fitted, nuisances, other), correlation});
    }
  std::ranges::stable_sort(found, std::ranges::greater{},
                           [](const ParameterCorrelation& c) { return std::abs(c.correlation); });
  return found;
}

/// Wald's test of all amplitudes together: of a vector one component may be known and the other not.
bool is_told_from_zero(const Refit& fitted, std::size_t effect) {
  const ActiveEffect& active = fitted.state.effects[effect];
  const std::string& name = active.candidate.effect().strength().name;
  const std::vector<Eigen::Index> rows = covariance_rows(fitted, effect, name);
  const auto size = static_cast<Eigen::Index>(active.amplitude.size());
  const Eigen::VectorXd amplitude = Eigen::VectorXd::Map(active.amplitude.data(), size);
  const double least =
      static_cast<double>(size) *
      boost::math::quantile(boost::math::fisher_f(static_cast<double>(size), degrees_of(fitted)), 0.95);
  for (const Eigen::MatrixXd* all : {&fitted.covariance, &fitted.run_covariance}) {
    const Eigen::MatrixXd own = (*all)(rows, rows);
    const double form = form_sd(active, name);
    const Eigen::MatrixXd covariance = own + form * form * Eigen::MatrixXd::Identity(size, size);
    if (!(amplitude.dot(covariance.ldlt().solve(amplitude)) > least)) return false;
  }
  return true;
}

bool is_inside_range(const Refit& fitted, std::size_t effect, const Robot& robot) {
  const ActiveEffect& active = fitted.state.effects[effect];
  double square = 0;
  for (double amplitude : active.amplitude) square += amplitude * amplitude;
  return outside_range(active.candidate, active.amplitude, robot) <= 1e-6 * std::sqrt(square);
}

}  // namespace joulepath
