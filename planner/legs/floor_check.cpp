#include "planner/legs/floor_check.hpp"

#include <cstdio>

#include "planner/path/floor/path_conflict.hpp"
// Design: docs/decisions/0201-routes-and-floor.md
namespace joulepath {
namespace {

std::string text_of(const PathConflict& conflict, double clearance_m) {
  const Collision& deepest = conflict.deepest;
  const ObstacleField::Nearest& obstacle = deepest.obstacle;
  char what[160], text[480];
  if (deepest.short_by_m > clearance_m)
    std::snprintf(what, sizeof what, "the footprint overlaps %s at (%.3f, %.3f) m by %.3f m",
                  name_of(obstacle.layer), obstacle.x_m, obstacle.y_m, deepest.short_by_m - clearance_m);
  else
    std::snprintf(what, sizeof what,
                  "the footprint comes %.3f m closer than clearance_m = %g m to %s at (%.3f, %.3f) m",
                  deepest.short_by_m, clearance_m, name_of(obstacle.layer), obstacle.x_m, obstacle.y_m);
  std::snprintf(
      text, sizeof text,
      "%s, %.3f m along the path with the axle at (%.3f, %.3f) m; the path is blocked from %.3f m on, "
      "in %zu place%s, over %.3f m in all",
      what, conflict.deepest_m, deepest.pose.x_m, deepest.pose.y_m, conflict.first_m, conflict.stretches,
      conflict.stretches == 1 ? "" : "s", conflict.length_m);
  return text;
}

Infeasibility verdict_on(const PathConflict& conflict, double clearance_m) {
  return {.constraint = "path",
          .s = conflict.deepest_m,
          .x_m = conflict.deepest.pose.x_m,
          .y_m = conflict.deepest.pose.y_m,
          .amount = conflict.deepest.short_by_m,
          .unit = "m",
          .message = text_of(conflict, clearance_m)};
}

}  // namespace

std::optional<Infeasibility> blocked_path(const Path& path, const RouteSpace& space) {
  const FootprintChecker& checker = space.checker();
  const auto conflict = path_conflict(checker, path);
  if (!conflict) return std::nullopt;
  Infeasibility verdict = verdict_on(*conflict, checker.clearance_m());
  constexpr double kSpare_m = 1e-4;  // margin for places between the checked ones
  const double room_m = checker.clearance_m() - conflict->deepest.short_by_m - kSpare_m;
  if (room_m >= 0 && !path_conflict(checker.with_clearance(room_m), path))
    verdict.relaxation = {{"clearance_m", room_m}};
  return verdict;
}

std::optional<Infeasibility> blocked_motion(const Trajectory& motion, const RouteSpace& space) {
  const auto conflict = motion_conflict(space.checker(), motion);
  if (!conflict) return std::nullopt;
  return verdict_on(*conflict, space.checker().clearance_m());
}

}  // namespace joulepath
