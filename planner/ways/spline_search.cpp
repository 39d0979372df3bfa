#include "planner/ways/spline_search.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "planner/path/shape/nlopt_run.hpp"

namespace joulepath {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kClearanceMargin_m = 0.002;

}  // namespace

double blocked(const FootprintChecker& checker, const Path& path) {
  const double slack_m = checker.least_slack_m(path);
  return slack_m < kClearanceMargin_m ? kBlocked * (1 + std::min(1.0, kClearanceMargin_m - slack_m)) : 0.0;
}

void SplineVariables::add_handle(double length_m, double first_step_m) {
  value.push_back(length_m);
  first_step.push_back(first_step_m);
  lower.push_back(kLeastHandle_m);
}

void SplineVariables::add_heading(double heading_rad) {
  value.push_back(heading_rad);
  first_step.push_back(kFirstTurn_rad);
  lower.push_back(-kInfinity);
}

void SplineVariables::add_knot(const Point2& place_m, double first_step_m) {
  for (const double coordinate_m : place_m) {
    value.push_back(coordinate_m);
    first_step.push_back(first_step_m);
    lower.push_back(-kInfinity);
  }
}

double minimize(SplineVariables& variables, const SearchEffort& effort,
                const std::function<double(const std::vector<double>&)>& value) {
  std::vector<double>& x = variables.value;
  nlopt::opt optimizer(nlopt::LN_SBPLX, static_cast<unsigned>(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::max(x[i], variables.lower[i]);
  optimizer.set_lower_bounds(variables.lower);
  optimizer.set_initial_step(variables.first_step);
  optimizer.set_min_objective(
      [](const std::vector<double>& at, std::vector<double>&, void* data) {
        return (*static_cast<const std::function<double(const std::vector<double>&)>*>(data))(at);
      },
      const_cast<std::function<double(const std::vector<double>&)>*>(&value));
  optimizer.set_ftol_rel(effort.relative_tolerance);
  optimizer.set_xtol_rel(1e-5);
  optimizer.set_maxeval(effort.evaluations_per_variable * static_cast<int>(x.size()));
  const std::optional<double> found = optimize_as_far_as_possible(optimizer, x);
  return found ? *found : value(x);
}

}  // namespace joulepath
