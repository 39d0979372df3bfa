#include "diagnosis/steps/parameters.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath {
namespace {

constexpr double kPatchEdge_m = 0.05;  ///< half a step of the scan for a floor patch

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

/// Standard deviation of a slope's grade or direction, from those of its components.
double slope_sd(const Refit& fitted, const ActiveEffect& slope, const std::vector<Eigen::Index>& rows,
                bool direction) {
  const double x = slope.amplitude[0], y = slope.amplitude[1], grade = std::max(1e-9, std::hypot(x, y));
  const double gx = direction ? -y / (grade * grade) : x / grade,
               gy = direction ? x / (grade * grade) : y / grade;
  return std::sqrt(std::max(0.0, gx * gx * fitted.covariance(rows[0], rows[0]) +
                                     gy * gy * fitted.covariance(rows[1], rows[1]) +
                                     2 * gx * gy * fitted.covariance(rows[0], rows[1])));
}

double parameter_sd(const Refit& fitted, std::size_t effect, const std::string& name) {
  const ActiveEffect& active = fitted.state.effects[effect];
  const std::vector<Eigen::Index> rows = covariance_rows(fitted, effect, name);
  if (rows.empty()) return kPatchEdge_m;
  if (active.candidate.shape.name == "floor_slope") return slope_sd(fitted, active, rows, name != "grade");
  return std::sqrt(fitted.covariance(rows[0], rows[0]));
}

}  // namespace

std::vector<FoundParameter> found_parameters(const Refit& fitted, std::size_t effect, const Robot& robot) {
  const ActiveEffect& active = fitted.state.effects[effect];
  const EffectSetting setting = setting_of(active.candidate, active.amplitude, robot);
  std::vector<FoundParameter> found;
  for (const ParameterDescription& parameter : find_effect(setting.name)->parameters) {
    const auto at = setting.parameters.find(parameter.name);
    if (at == setting.parameters.end()) continue;
    const double sd = parameter_sd(fitted, effect, parameter.name);
    Range95 interval{at->second - 1.96 * sd, at->second + 1.96 * sd};
    if (setting.name == "wheel_slip") {  // symmetric in the compliance
      const double compliance = 1 / at->second;
      interval = {1 / (compliance + 1.96 * sd), 1 / std::max(1e-9, compliance - 1.96 * sd)};
    }
    found.push_back({parameter.name, at->second, interval});
  }
  return found;
}

}  // namespace joulepath
