#include "planner/path/floor/path_conflict.hpp"

#include <algorithm>
#include <cmath>

#include "model/sampled_motion.hpp"
#include "planner/path/floor/outline_sweep.hpp"
// Design: docs/decisions/0201-routes-and-floor.md
namespace joulepath {
namespace {

constexpr double kStands_m = 1e-6;  ///< an outline that moves by less is at rest

/// Collects places in their order along a way.
class ConflictSearch {
 public:
  void look(double arc_m, double s, const Pose& pose, double slack_m, const FootprintChecker& checker) {
    const bool inside = slack_m < -FootprintChecker::kTolerance_m;
    if (inside && !inside_) {
      if (conflict_.stretches == 0) conflict_.first_m = arc_m;
      ++conflict_.stretches;
    } else if (inside_) {
      conflict_.length_m += arc_m - last_m_;
    }
    if (inside) {
      const Collision here = checker.collision_at(s, pose, slack_m);
      if (here.short_by_m > conflict_.deepest.short_by_m) {
        conflict_.deepest_m = arc_m;
        conflict_.deepest = here;
      }
    }
    inside_ = inside;
    last_m_ = arc_m;
  }

  std::optional<PathConflict> found() const {
    return conflict_.stretches > 0 ? std::optional(conflict_) : std::nullopt;
  }

 private:
  PathConflict conflict_{};
  double last_m_{};
  bool inside_{};
};

}  // namespace

std::optional<PathConflict> path_conflict(const FootprintChecker& checker, const Path& path) {
  ConflictSearch search;
  double before_m = 0;
  for (const PathPiece& piece : path.pieces) {
    const bool turns = is_turn(piece);
    sweep_outline(
        checker, piece_length(piece), checker.reach_per_s(piece),
        [&](double s) { return piece_point(piece, s).pose; },
        [&](double s, const Pose& pose, double slack_m) {
          search.look(turns ? before_m : before_m + s, s, pose, slack_m, checker);
          return true;
        });
    if (!turns) before_m += piece_length(piece);
  }
  return search.found();
}

std::optional<PathConflict> motion_conflict(const FootprintChecker& checker, const Trajectory& motion) {
  ConflictSearch search;
  for (std::size_t k = 0; k + 1 < motion.size(); ++k) {
    const double from_s = motion.time_s[k], lasts_s = motion.time_s[k + 1] - from_s;
    const double moves_m = std::hypot(motion.position_x_m[k + 1] - motion.position_x_m[k],
                                      motion.position_y_m[k + 1] - motion.position_y_m[k]);
    const double turns_rad = std::abs(motion.heading_rad[k + 1] - motion.heading_rad[k]);
    const double reach_m = moves_m + checker.circumscribed_radius_m() * turns_rad;
    sweep_outline(
        checker, lasts_s, std::max(reach_m, kStands_m) / lasts_s,
        [&](double s) { return sampled_state(motion, from_s + s).pose; },
        [&](double s, const Pose& pose, double slack_m) {
          search.look(sampled_state(motion, from_s + s).arc_length_m, s, pose, slack_m, checker);
          return true;
        });
  }
  return search.found();
}

}  // namespace joulepath
