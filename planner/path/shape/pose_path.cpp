#include "planner/path/shape/pose_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planner/path/shape/bezier_chain.hpp"
#include "planner/path/shape/direction_fit.hpp"
#include "planner/path/shape/smoothing_spline.hpp"
// Design: docs/decisions/0200-paths.md
namespace joulepath {
namespace {

constexpr double kStands_m = 1e-4;        ///< the robot stands, or turns in place
constexpr double kStandsExact_m = 1e-6;   ///< the same, of exact poses
constexpr double kAlongMotion_rad = 0.5;  ///< a heading that says how the robot drives
constexpr double kShareAlongMotion = 0.9;
constexpr double kExact_m = 2e-3;       ///< a planner's poses are so exact
constexpr double kTurnLength_m = 0.25;  ///< of turns compared with ways
constexpr double kJump_m = 0.005, kJump_rad = 0.2;
constexpr double kTurnsHere_rad = 0.02;  ///< a change of heading at one place that is no rounding

double moved_m(const Pose& from, const Pose& to) { return std::hypot(to.x_m - from.x_m, to.y_m - from.y_m); }

/// Angle of the motion against the heading at its begin.
double off_heading_rad(const Pose& from, const Pose& to) {
  return wrapped_angle_rad(std::atan2(to.y_m - from.y_m, to.x_m - from.x_m) - from.heading_rad);
}

/// Poses from one place to the next; `turned_rad`: how far the heading changed at the first of them before.
struct Stretch {
  double turned_rad{};
  Direction direction{};
  std::vector<Pose> poses{};
};

bool headings_tell(const std::vector<Pose>& poses) {
  std::size_t steps = 0, along = 0;
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    if (moved_m(poses[i], poses[i + 1]) <= kStands_m) continue;
    const double off = std::abs(off_heading_rad(poses[i], poses[i + 1]));
    ++steps;
    along += std::min(off, std::numbers::pi - off) < kAlongMotion_rad;
  }
  return static_cast<double>(along) >= kShareAlongMotion * static_cast<double>(steps);
}

/// The stretches between stops, and the angle turned after the last one.
struct Stretches {
  std::vector<Stretch> all{};
  double turned_rad{};
};

/// Whether the robot stopped between two steps of exact poses: it turns otherwise after a few millimeters.
bool stops_between(const Pose& before, const Pose& here, const Pose& after) {
  const auto turn_per_m = [](const Pose& from, const Pose& to) {
    return std::atan2(kTurnLength_m * wrapped_angle_rad(to.heading_rad - from.heading_rad),
                      moved_m(from, to));
  };
  return moved_m(before, here) + moved_m(here, after) < kJump_m &&
         std::abs(turn_per_m(here, after) - turn_per_m(before, here)) > kJump_rad;
}

/// `exact`: poses of a planner.
Stretches stretches_of(const std::vector<Pose>& poses, bool exact) {
  const double stands_m = exact ? kStandsExact_m : kStands_m;
  Stretches result;
  double turned_rad = 0;
  Pose here = poses.front(), arrived = here;  // the same place, before and after a turn there
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Pose& next = poses[i];
    if (moved_m(here, next) <= stands_m) {
      turned_rad += wrapped_angle_rad(next.heading_rad - here.heading_rad);
      here.heading_rad = next.heading_rad;
      continue;
    }
    const Direction direction =
        std::cos(off_heading_rad(here, next)) > 0 ? Direction::forward : Direction::reverse;
    const bool goes_on = !result.all.empty() && result.all.back().direction == direction &&
                         std::abs(turned_rad) < kTurnsHere_rad &&
                         !(exact && stops_between(*(result.all.back().poses.end() - 2), here, next));
    if (!goes_on) {
      const bool turns = std::abs(turned_rad) >= kTurnsHere_rad;
      result.all.push_back({turned_rad, direction, {turns ? here : arrived}});
    }
    turned_rad = 0;
    result.all.back().poses.push_back(next);
    here = arrived = next;
  }
  result.turned_rad = turned_rad;
  return result;
}

/// A turn in place from the path's end (or `from`) to a heading, as many times round as `turned_rad` says.
void append_turn(Path& path, const Pose& from, double heading_rad, double turned_rad) {
  const Pose start = path.pieces.empty() ? from : path.end();
  const double least_rad = wrapped_angle_rad(heading_rad - start.heading_rad),
               round_rad = 2 * std::numbers::pi;
  const double angle_rad = least_rad + round_rad * std::round((turned_rad - least_rad) / round_rad);
  if (std::abs(angle_rad) > 1e-9) path.pieces.emplace_back(TurnInPlace{start, angle_rad});
}

/// The curve along exact poses of a stretch; nothing where they are not exact.
std::optional<Curve> exact_curve_along(const Stretch& stretch, double tolerance_m) {
  std::vector<Pose> tangents = stretch.poses;
  if (stretch.direction == Direction::reverse)
    for (Pose& pose : tangents) pose.heading_rad += std::numbers::pi;
  return direction_fit(tangents, std::min(tolerance_m, kExact_m), stretch.direction);
}

/// The curve along a stretch; nothing where no spline keeps its places and headings.
std::optional<Curve> smooth_curve_along(const Stretch& stretch, double tolerance_m) {
  std::vector<Point2> points_m, directions;
  const double sign = stretch.direction == Direction::forward ? 1.0 : -1.0;
  for (const Pose& pose : stretch.poses) {
    points_m.push_back({pose.x_m, pose.y_m});
    directions.push_back({sign * std::cos(pose.heading_rad), sign * std::sin(pose.heading_rad)});
  }
  const SmoothingSpline spline = smoothing_spline(points_m, tolerance_m, directions);
  std::vector<CurveSegment> segments;
  for (std::size_t i = 0; i < spline.curves_m.size(); ++i) {
    if (!bezier_defects(spline.curves_m[i], i).empty()) return std::nullopt;
    segments.push_back(BezierSegment(spline.curves_m[i]));
  }
  if (spline.deviation_m > tolerance_m) return std::nullopt;
  return Curve(std::move(segments), stretch.direction);
}

WaypointPath along_places(const std::vector<Pose>& poses, double tolerance_m) {
  std::vector<Point2> points_m;
  for (const Pose& pose : poses)
    if (points_m.empty() ||
        std::hypot(pose.x_m - points_m.back()[0], pose.y_m - points_m.back()[1]) > kStands_m)
      points_m.push_back({pose.x_m, pose.y_m});
  return curve_through(points_m, tolerance_m);
}

/// Curves along the stretches between places where the robot stands, and the turns there; nothing where a
/// stretch has no curve.
template <class CurveAlong>
std::optional<Path> joined(const std::vector<Pose>& poses, bool exact, const CurveAlong& curve_along) {
  Path path;
  const Stretches stretches = stretches_of(poses, exact);
  for (const Stretch& stretch : stretches.all) {
    const std::optional<Curve> curve = curve_along(stretch);
    if (!curve) return std::nullopt;
    const bool turns = !path.pieces.empty() || std::abs(stretch.turned_rad) >= kTurnsHere_rad;
    if (turns) append_turn(path, poses.front(), curve->at(0).pose.heading_rad, stretch.turned_rad);
    path.pieces.emplace_back(*curve);
  }
  if (path.pieces.empty() || std::abs(stretches.turned_rad) >= kTurnsHere_rad)
    append_turn(path, poses.front(), poses.back().heading_rad, stretches.turned_rad);
  return path;
}

}  // namespace

WaypointPath path_along_poses(const std::vector<Pose>& poses, double tolerance_m) {
  if (!headings_tell(poses)) return along_places(poses, tolerance_m);
  std::optional<Path> path =
      joined(poses, true, [&](const Stretch& stretch) { return exact_curve_along(stretch, tolerance_m); });
  const bool exact = path.has_value();
  if (!exact)
    path = joined(poses, false,
                  [&](const Stretch& stretch) { return smooth_curve_along(stretch, tolerance_m); });
  if (!path) return along_places(poses, tolerance_m);
  WaypointPath along{.path = std::move(*path), .exact = exact};
  if (along.path.pieces.empty())
    along.defect = WaypointDefect{0, false, "poses that stand still", "poses that move or turn"};
  return along;
}

}  // namespace joulepath
