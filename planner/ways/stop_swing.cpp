#include "planner/ways/stop_swing.hpp"

#include <cmath>

#include "planner/ways/spline_search.hpp"

namespace joulepath {

std::optional<StopResult> best_stop(const StopRequest& request, const FootprintChecker& checker,
                                    const SearchEffort& effort) {
  std::optional<StopResult> best;
  const bool knot_before = request.before.points_m.size() > 2, knot_after = request.after.points_m.size() > 2;
  const auto splines_at = [&](const std::vector<double>& x) {
    std::pair<FreeSpline, FreeSpline> splines{request.before, request.after};
    auto& [before, after] = splines;
    std::size_t i = 0;
    before.goal_handle_m = x[i++];
    after.start_handle_m = x[i++];
    before.goal_heading_rad = after.start_heading_rad = x[i++];
    if (knot_before) before.points_m[before.points_m.size() - 2] = {x[i], x[i + 1]}, i += 2;
    if (knot_after) after.points_m[1] = {x[i], x[i + 1]};
    return splines;
  };
  const auto value = [&](const std::vector<double>& x) {
    const auto [before, after] = splines_at(x);
    std::optional<Path> first = free_spline_path(before), second = free_spline_path(after);
    if (!first || !second) return kNoCurve;
    if (const double in_the_way = blocked(checker, *first) + blocked(checker, *second)) return in_the_way;
    const double cost = request.cost(*first, *second);
    if (!std::isfinite(cost)) return kNotDrivable;
    if ((!best || cost < best->cost) && !checker.first_collision(*first) && !checker.first_collision(*second))
      best = {.before = {.spline = before, .path = std::move(*first)},
              .after = {.spline = after, .path = std::move(*second)},
              .cost = cost};
    return cost;
  };
  for (const double heading_rad : {request.after.start_heading_rad, request.before.goal_heading_rad}) {
    SplineVariables variables;
    for (const double handle_m : {request.before.goal_handle_m, request.after.start_handle_m})
      variables.add_handle(handle_m, 0.5 * handle_m);
    variables.add_heading(heading_rad);
    if (knot_before)
      variables.add_knot(request.before.points_m[request.before.points_m.size() - 2], kFirstStep_m);
    if (knot_after) variables.add_knot(request.after.points_m[1], kFirstStep_m);
    (void)minimize(variables, effort, value);
    if (request.after.start_heading_rad == request.before.goal_heading_rad) break;
  }
  return best;
}

}  // namespace joulepath
