#include "diagnosis/correction/parameters.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <functional>

#include "diagnosis/thresholds.hpp"
#include "model/student_t.hpp"
// Design: docs/decisions/0507-cross-fitting.md
// Method: [Davies1977], [Wald1943]
namespace joulepath {
namespace {

const Column& column_of(const Refit& fitted, Eigen::Index row) {
  return fitted.equations.columns[static_cast<std::size_t>(fitted.columns[static_cast<std::size_t>(row)])];
}

/// Rows of the refit's covariance that belong to shapes of an effect's law: edges of a region alone, or all.
std::vector<Eigen::Index> shape_rows(const Refit& fitted, std::size_t effect,
                                     const std::function<bool(const ParameterDescription&)>& chosen) {
  const Candidate& candidate = fitted.state.effects[effect].candidate;
  const std::vector<std::string> shapes = shape_parameters(candidate.shape.name);
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < std::ssize(fitted.columns); ++i) {
    const Column& column = column_of(fitted, i);
    if (column.kind == Column::Kind::shape && column.owner == static_cast<int>(effect) &&
        chosen(*candidate.effect().find(shapes[static_cast<std::size_t>(column.part)])))
      rows.push_back(i);
  }
  return rows;
}

/// Covariances of an effect's amplitudes where some rows of the fit are held: what the noise model says, and
/// what the runs' differences say.
std::array<Eigen::MatrixXd, 2> amplitude_covariances(const Refit& fitted, std::size_t effect,
                                                     const std::vector<Eigen::Index>& held) {
  std::vector<Eigen::Index> kept, own;
  for (Eigen::Index i = 0; i < std::ssize(fitted.columns); ++i) {
    if (std::ranges::count(held, i) > 0) continue;
    const Column& column = column_of(fitted, i);
    if (column.kind == Column::Kind::amplitude && column.owner == static_cast<int>(effect))
      own.push_back(std::ssize(kept));
    kept.push_back(i);
  }
  const Eigen::MatrixXd precision = fitted.covariance.inverse();
  const Eigen::MatrixXd free = Eigen::MatrixXd(precision(kept, kept)).inverse();
  const Eigen::MatrixXd scores = precision * fitted.run_covariance * precision;
  const Eigen::MatrixXd by_runs = free * scores(kept, kept) * free;
  return {free(own, own), by_runs(own, own)};
}

/// Standard deviation along a gradient: the greater of what the noise model and the runs' differences say.
double sd_along(const std::array<Eigen::MatrixXd, 2>& covariances, const Eigen::VectorXd& gradient) {
  double greatest = 0;
  for (const Eigen::MatrixXd& covariance : covariances)
    greatest = std::max(greatest, gradient.dot(covariance * gradient));
  return std::sqrt(greatest);
}

/// Size or direction of a vector, as a gradient over its components.
Eigen::VectorXd polar_gradient(const ActiveEffect& vector, bool direction) {
  const double x = vector.amplitude[0], y = vector.amplitude[1], size = std::max(1e-9, std::hypot(x, y));
  if (direction) return Eigen::Vector2d{-y / (size * size), x / (size * size)};
  return Eigen::Vector2d{x / size, y / size};
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

/// Standard deviation of a parameter. An edge moves in steps past a path along it, and takes a law away or
/// leaves it whole: no strength makes up for that, so a strength is as well known as the held edges leave it.
double parameter_sd(const Refit& fitted, std::size_t effect, const std::string& name) {
  const EffectDescription& effect_of = fitted.state.effects[effect].candidate.effect();
  const ParameterRole role = effect_of.find(name)->role;
  if (role == ParameterRole::shape || role == ParameterRole::edge) {
    const std::vector<Eigen::Index> rows =
        shape_rows(fitted, effect, [&](const ParameterDescription& shape) { return shape.name == name; });
    if (rows.empty()) return 0.5 * kRegionStep_m;
    return sd_along({fitted.covariance(rows, rows), fitted.run_covariance(rows, rows)},
                    Eigen::VectorXd::Ones(1));
  }
  const std::vector<Eigen::Index> edges = shape_rows(
      fitted, effect, [](const ParameterDescription& shape) { return shape.role == ParameterRole::edge; });
  return sd_along(amplitude_covariances(fitted, effect, edges),
                  effect_of.find(ParameterRole::direction)
                      ? polar_gradient(fitted.state.effects[effect], name != effect_of.strength().name)
                      : Eigen::VectorXd::Ones(1));
}

/// Half a 95 % interval, for the number of runs that it rests on.
double half_interval(const Refit& fitted, std::size_t effect, const std::string& name) {
  return std::hypot(parameter_sd(fitted, effect, name), form_sd(fitted.state.effects[effect], name)) *
         student_t_975(degrees_of(fitted));
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

/// Wald's test of all amplitudes together: of a vector one component may be known and the other not. A law
/// of no size has no shape: its shapes are held, and each, chosen for its fit, counts as one more amplitude.
bool is_told_from_zero(const Refit& fitted, std::size_t effect) {
  const ActiveEffect& active = fitted.state.effects[effect];
  const auto size = static_cast<Eigen::Index>(active.amplitude.size());
  const Eigen::VectorXd amplitude = Eigen::VectorXd::Map(active.amplitude.data(), size);
  const std::vector<Eigen::Index> shapes =
      shape_rows(fitted, effect, [](const ParameterDescription&) { return true; });
  const auto chosen = static_cast<double>(size + std::ssize(shapes));
  const double least =
      chosen * boost::math::quantile(boost::math::fisher_f(chosen, degrees_of(fitted)), 0.95);
  const double form = form_sd(active, active.candidate.effect().strength().name);
  for (Eigen::MatrixXd covariance : amplitude_covariances(fitted, effect, shapes)) {
    covariance.diagonal().array() += form * form;
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
