#include "planner/path/shape/pose_path.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "planner/path/shape/bezier_chain.hpp"
#include "planner/path/shape/direction_fit.hpp"
#include "planner/path/shape/smoothing_spline.hpp"
// Design: docs/decisions/0200-paths.md
namespace joulepath {
namespace {

constexpr double kStands_m = 1e-4;        ///< the robot stands, or turns in place
constexpr double kStandsExact_m = 3e-6;   ///< the same, of exact poses
constexpr double kAlongMotion_rad = 0.5;  ///< a heading that says how the robot drives
constexpr double kShareAlongMotion = 0.9;
constexpr double kExact_m = 2e-3;  ///< a planner's poses are so exact
constexpr double kWheel_m = 0.25;  ///< from a robot's middle to a wheel, where only poses are known
constexpr double kShrinks = 0.7;   ///< a step to that before, near a stop
constexpr double kStop_m = 0.005;  ///< both steps at a stop together
constexpr double kStop_rad = 0.2;  ///< between the angles of driving and turning there
constexpr double kRougher = 1.05,
                 kRougher_per_m = 0.02;               ///< of the spline's bending: what exact poses may have
constexpr double kStep_rad_m = 15, kNearEnd_m = 0.1;  ///< a step of the curvature, not of a start or a stop
constexpr int kLooks = 400;                           ///< points of a curve at which bending is summed
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

/// Whether the robot stopped at an exact pose: steps shrink towards it and grow after it, as those of a plan
/// over time, and it turns otherwise after a few millimeters. A stretch has arrived there.
bool stops_at(std::size_t here, const std::vector<Pose>& poses, const std::vector<Pose>& stretch) {
  if (stretch.size() < 3 || here + 2 >= poses.size()) return false;
  const auto step_m = [](const Pose* from) { return moved_m(from[0], from[1]); };
  const auto phi_rad = [&](const Pose* from) {
    return std::atan2(kWheel_m * wrapped_angle_rad(from[1].heading_rad - from[0].heading_rad), step_m(from));
  };
  const Pose *before = &*(stretch.end() - 3), *after = &poses[here];
  return step_m(before + 1) < kShrinks * step_m(before) && step_m(after) < kShrinks * step_m(after + 1) &&
         step_m(before + 1) + step_m(after) < kStop_m &&
         std::abs(phi_rad(after) - phi_rad(before + 1)) > kStop_rad;
}

/// `exact`: the poses are a planner's, so that a stand is narrower and a stop without a turn is seen.
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
                         !(exact && stops_at(i - 1, poses, result.all.back().poses));
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

/// Whether lines and arcs follow each other, which a tolerance rounds better.
bool steps_in_curvature(const Curve& curve) {
  for (std::size_t k = 0; k < curve.segments().size(); ++k) {
    const auto& shape = std::get<DirectionSegment>(curve.segments()[k]).shape();
    const bool inside =
        curve.breakpoints_m()[k] > kNearEnd_m && curve.breakpoints_m()[k + 1] < curve.length_m() - kNearEnd_m;
    if (inside && std::abs(shape.to_rad - shape.from_rad) > kStep_rad_m * shape.length_m) return true;
  }
  return false;
}

/// The curve along exact poses of a stretch; nothing where they are not exact.
std::optional<Curve> exact_curve_along(const Stretch& stretch, double tolerance_m) {
  std::vector<Pose> tangents = stretch.poses;
  if (stretch.direction == Direction::reverse)
    for (Pose& pose : tangents) pose.heading_rad += std::numbers::pi;
  std::optional<Curve> curve = direction_fit(tangents, std::min(tolerance_m, kExact_m), stretch.direction);
  if (curve && steps_in_curvature(*curve)) return std::nullopt;
  return curve;
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

/// The curve through the places of poses that no curve follows; the headings at both ends are kept by turns.
WaypointPath between_headings(const std::vector<Pose>& poses, double tolerance_m) {
  WaypointPath along = along_places(poses, tolerance_m);
  if (along.defect || along.path.pieces.empty()) return along;
  Path path;
  const auto turn_to = [&](double from_rad, double heading_rad) {
    const double turned_rad = wrapped_angle_rad(heading_rad - from_rad);
    if (std::abs(turned_rad) > kAlongMotion_rad) append_turn(path, poses.front(), heading_rad, turned_rad);
  };
  turn_to(poses.front().heading_rad, along.path.start().heading_rad);
  std::move(along.path.pieces.begin(), along.path.pieces.end(), std::back_inserter(path.pieces));
  turn_to(path.end().heading_rad, poses.back().heading_rad);
  along.path = std::move(path);
  return along;
}

/// Curves along the stretches between places where the robot stands, and the turns there; nothing where a
/// stretch has no curve.
std::optional<Path> joined(const std::vector<Pose>& poses, bool exact, double tolerance_m) {
  const auto curve_along = exact ? exact_curve_along : smooth_curve_along;
  Path path;
  const Stretches stretches = stretches_of(poses, exact);
  for (const Stretch& stretch : stretches.all) {
    const std::optional<Curve> curve = curve_along(stretch, tolerance_m);
    if (!curve) return std::nullopt;
    const bool turns = !path.pieces.empty() || std::abs(stretch.turned_rad) >= kTurnsHere_rad;
    if (turns) append_turn(path, poses.front(), curve->at(0).pose.heading_rad, stretch.turned_rad);
    path.pieces.emplace_back(*curve);
  }
  if (path.pieces.empty() || std::abs(stretches.turned_rad) >= kTurnsHere_rad)
    append_turn(path, poses.front(), poses.back().heading_rad, stretches.turned_rad);
  return path;
}

/// The squares of the changes of the angle between driving and turning per length, along the curves of a
/// path.
double bending(const Path& path) {
  double all_per_m = 0;
  for (const PathPiece& piece : path.pieces) {
    const auto* curve = std::get_if<Curve>(&piece);
    if (curve == nullptr) continue;
    double before = std::atan(kWheel_m * curve->bend(0).curvature_per_m);
    for (int k = 1; k <= kLooks; ++k) {
      const double here = std::atan(kWheel_m * curve->bend(curve->length_m() * k / kLooks).curvature_per_m);
      const double change_rad = here - std::exchange(before, here);
      all_per_m += change_rad * change_rad * kLooks / curve->length_m();
    }
  }
  return all_per_m;
}

}  // namespace

WaypointPath path_along_poses(const std::vector<Pose>& poses, double tolerance_m) {
  if (!headings_tell(poses)) return along_places(poses, tolerance_m);
  std::optional<Path> smooth = joined(poses, false, tolerance_m), exact;
  if (tolerance_m <= kWaypointTolerance_m) exact = joined(poses, true, tolerance_m);
  if (exact && smooth && bending(*exact) > kRougher * bending(*smooth) + kRougher_per_m) exact.reset();
  if (!exact && !smooth) return between_headings(poses, tolerance_m);
  WaypointPath along{.path = exact ? std::move(*exact) : std::move(*smooth), .exact = exact.has_value()};
  if (along.path.pieces.empty())
    along.defect = WaypointDefect{0, false, "poses that stand still", "poses that move or turn"};
  return along;
}

}  // namespace joulepath
