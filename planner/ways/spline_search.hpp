#pragma once

#include <functional>
#include <vector>

#include "planner/path/floor/footprint_checker.hpp"
#include "planner/path/geometry/path.hpp"
#include "planner/path/geometry/polygon_distance.hpp"

namespace joulepath {

/// Values above every cost, for splines that cannot be driven; they lead the optimizer away from them.
inline constexpr double kBlocked = 1e9;  ///< blocked by an obstacle; larger for a deeper collision
inline constexpr double kNotDrivable = 2.5 * kBlocked;  ///< no profile within the limits
inline constexpr double kNoCurve = 3 * kBlocked;        ///< a cusp

inline constexpr double kFirstStep_m = 0.15;   ///< of knots and long handles
inline constexpr double kFirstTurn_rad = 0.3;  ///< of a free heading
inline constexpr double kLeastHandle_m = 0.01;

/// 0 where a path is free, else kBlocked and more.
[[nodiscard]] double blocked(const FootprintChecker& checker, const Path& path);

/// Start of an optimizer over the variables of a spline.
struct SplineVariables {
  std::vector<double> value{};
  std::vector<double> first_step{};
  std::vector<double> lower{};

  void add_handle(double length_m, double first_step_m);
  void add_heading(double heading_rad);
  void add_knot(const Point2& place_m, double first_step_m);
};

struct SearchEffort {
  int evaluations_per_variable{25};
  double relative_tolerance{1e-6};  ///< of the value
};

/// Minimizes with NLopt's Subplex and moves `variables.value` to the best point. Returns the value there.
[[nodiscard]] double minimize(SplineVariables& variables, const SearchEffort& effort,
                              const std::function<double(const std::vector<double>&)>& value);

}  // namespace joulepath
