#include "planner/path/shape/waypoint_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/printable.hpp"
#include "planner/path/geometry/rounding.hpp"
#include "planner/path/shape/bezier_chain.hpp"
#include "planner/path/shape/corner_blend.hpp"
#include "planner/path/shape/smoothing_spline.hpp"
// Design: docs/decisions/0200-paths.md

namespace joulepath {
namespace {

constexpr double kSamePlace_m = 1e-5;  ///< of dense waypoints: the robot stood
constexpr double kLeastRound_m =
    1e-4;  ///< the path leaves a rounded corner at least by this, where it has room
constexpr double kTurnsBackDense_rad = 2.8;
constexpr double kLook = 5;   ///< length, in tolerances, over which the direction of dense waypoints is taken
constexpr double kDense = 8;  ///< tolerances between neighbors
constexpr std::size_t kMany = 1000;

std::string metres(double value_m) { return four_digits(value_m) + " m"; }

/// Rounded down to the four digits of metres(), so that a proposed value fits.
double proposed_m(double most_m) {
  constexpr double kClear = 1 - 1e-12;  // tolerance of comparisons, against rounding
  if (!(most_m > 0)) return 0;
  const double step_m = std::pow(10.0, std::floor(std::log10(most_m)) - 3);
  return step_m * std::floor(kClear * most_m / step_m);
}

std::vector<double> chords_m(const std::vector<Point2>& points_m) {
  std::vector<double> chords;
  for (std::size_t i = 0; i + 1 < points_m.size(); ++i)
    chords.push_back(std::hypot(points_m[i + 1][0] - points_m[i][0], points_m[i + 1][1] - points_m[i][1]));
  return chords;
}

std::optional<WaypointDefect> senseless(const std::vector<Point2>& points_m, double least_m) {
  if (points_m.size() < 2)
    return WaypointDefect{0, false, std::to_string(points_m.size()) + " waypoints", "two waypoints or more"};
  const std::vector<double> chord = chords_m(points_m);
  for (std::size_t i = 0; i < chord.size(); ++i)
    if (!(chord[i] >= least_m))
      return WaypointDefect{i + 1, false,
                            chord[i] > 0 ? metres(chord[i]) + " from the waypoint before"
                                         : std::string("the place of the waypoint before"),
                            "at least " + metres(least_m) + " from the waypoint before"};
  return std::nullopt;
}

/// Second derivatives (by chord length) of the natural cubic spline through `y` at the waypoints: the
/// three-term recurrence of continuous first derivatives, by elimination; the matrix is diagonally dominant.
std::vector<double> second_derivatives(const std::vector<double>& chord, const std::vector<double>& y) {
  const std::size_t n = y.size();
  std::vector<double> second(n, 0.0), above(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double pivot = 2 * (chord[i - 1] + chord[i]) - chord[i - 1] * above[i - 1];
    const double slope = (y[i + 1] - y[i]) / chord[i] - (y[i] - y[i - 1]) / chord[i - 1];
    above[i] = chord[i] / pivot;
    second[i] = (6 * slope - chord[i - 1] * second[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 1;) second[i] -= above[i] * second[i + 1];
  return second;
}

std::vector<BezierPoints> spline_m(const std::vector<Point2>& points_m) {
  const std::vector<double> chord = chords_m(points_m);
  std::vector<BezierPoints> curves(chord.size());
  for (std::size_t axis = 0; axis < 2; ++axis) {
    std::vector<double> y;
    for (const Point2& point : points_m) y.push_back(point[axis]);
    const std::vector<double> second = second_derivatives(chord, y);
    for (std::size_t i = 0; i < chord.size(); ++i) {
      const double h = chord[i], slope = (y[i + 1] - y[i]) / h;
      const double begin = slope - h * (2 * second[i] + second[i + 1]) / 6;
      const double end = slope + h * (second[i] + 2 * second[i + 1]) / 6;
      const double handles[] = {y[i], y[i] + h * begin / 3, y[i + 1] - h * end / 3, y[i + 1]};
      for (std::size_t k = 0; k < 4; ++k) curves[i][k][axis] = handles[k];
    }
  }
  return curves;
}

/// The verdict on a radius that is none.
std::optional<WaypointDefect> no_radius(const std::vector<double>& radius_m) {
  for (std::size_t i = 0; i < radius_m.size(); ++i)
    if (radius_m[i] != 0 && !(radius_m[i] >= kLeastCornerRadius_m))
      return WaypointDefect{i, true, metres(radius_m[i]),
                            "at least " + metres(kLeastCornerRadius_m) + ", or 0 to turn on the spot"};
  return std::nullopt;
}

/// From each corner back to where its blend begins; 0 without a blend.
std::vector<double> tangents_m(const std::vector<Point2>& points_m, const std::vector<double>& radius_m) {
  std::vector<double> tangents(points_m.size(), 0.0);
  for (std::size_t i = 1; i + 1 < points_m.size(); ++i) {
    const double angle = std::abs(corner_angle_rad(points_m, i));
    if (radius_m[i] > 0 && angle > kNoCorner_rad && angle <= kSharpestBlend_rad)
      tangents[i] = radius_m[i] * blend_shape(angle).tangent;
  }
  return tangents;
}

/// The radii as driven. A corner of a few microradians with a blend of half a meter would turn within
/// micrometers: a slight corner gets the radius at which its blend leaves it by kLeastRound_m, as far as half
/// of the room to its neighbors' blends allows. A corner within kRounding_rad is rounded even where the robot
/// would turn on the spot.
std::vector<double> driven_radii_m(const std::vector<Point2>& points_m, const std::vector<double>& radius_m) {
  const std::vector<double> chord = chords_m(points_m), tangent = tangents_m(points_m, radius_m);
  std::vector<double> driven = radius_m;
  for (std::size_t i = 1; i + 1 < points_m.size(); ++i) {
    const double angle = std::abs(corner_angle_rad(points_m, i));
    if (angle <= kNoCorner_rad || (radius_m[i] == 0 && angle > kRounding_rad)) continue;
    const BlendShape shape = blend_shape(angle);
    const double room_m = 0.5 * std::min(chord[i - 1] - tangent[i - 1], chord[i] - tangent[i + 1]);
    driven[i] = std::max(radius_m[i], std::min(kLeastRound_m / shape.deviation, room_m / shape.tangent));
  }
  return driven;
}

/// The verdict on a corner whose blend does not fit between the neighboring blends.
std::optional<WaypointDefect> too_wide(const std::vector<Point2>& points_m,
                                       const std::vector<double>& radius_m) {
  const std::vector<double> chord = chords_m(points_m), tangent = tangents_m(points_m, radius_m);
  for (std::size_t i = 1; i + 1 < points_m.size(); ++i)
    if (radius_m[i] > 0 && std::abs(corner_angle_rad(points_m, i)) > kSharpestBlend_rad)
      return WaypointDefect{i, true, metres(radius_m[i]) + " at a corner that turns back",
                            "0, to turn on the spot"};
  std::size_t widest = 0;
  double room_m = 0;
  for (std::size_t i = 1; i + 1 < points_m.size(); ++i) {
    const double room = std::min(chord[i - 1] - tangent[i - 1], chord[i] - tangent[i + 1]);
    if (tangent[i] > room && tangent[i] > tangent[widest]) widest = i, room_m = room;
  }
  if (widest == 0) return std::nullopt;
  const double most_m = std::max(0.0, room_m) * radius_m[widest] / tangent[widest];
  return WaypointDefect{widest, true, metres(radius_m[widest]),
                        "at most " + metres(proposed_m(most_m)) + " between its neighbors"};
}

bool are_dense(const std::vector<Point2>& points_m, double tolerance_m) {
  if (tolerance_m <= 0 || points_m.size() < 3) return false;
  double length_m = 0;
  for (const double chord : chords_m(points_m)) length_m += chord;
  return points_m.size() > kMany ||
         length_m < kDense * tolerance_m * static_cast<double>(points_m.size() - 1);
}

/// The places where a curve ends and the next begins after a turn in place: inner waypoints whose next
/// waypoint is straight behind.
std::vector<std::size_t> turning_points(const std::vector<Point2>& points_m) {
  std::vector<std::size_t> turns;
  for (std::size_t i = 1; i + 1 < points_m.size(); ++i)
    if (std::abs(corner_angle_rad(points_m, i)) > std::numbers::pi - kRounding_rad) turns.push_back(i);
  return turns;
}

/// The same for dense waypoints, over a length of a few tolerances: between neighbors the direction is mainly
/// rounding and noise.
std::vector<std::size_t> turning_points_of_dense(const std::vector<Point2>& points_m, double tolerance_m) {
  const auto apart_m = [&](const Point2& a, const Point2& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); };
  std::vector<std::size_t> kept{0};
  std::vector<Point2> coarse_m{points_m.front()};
  for (std::size_t i = 1; i < points_m.size(); ++i)
    if (apart_m(points_m[i], coarse_m.back()) >= kLook * tolerance_m) {
      kept.push_back(i);
      coarse_m.push_back(points_m[i]);
    }
  std::vector<std::size_t> turns;
  for (std::size_t k = 1; k + 1 < kept.size(); ++k) {
    if (std::abs(corner_angle_rad(coarse_m, k)) < kTurnsBackDense_rad) continue;
    const Point2 &a = coarse_m[k - 1], &b = coarse_m[k + 1];
    const Point2 middle_m{0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])};
    std::size_t apex = kept[k];
    for (std::size_t i = kept[k - 1] + 1; i < kept[k + 1]; ++i)
      if (apart_m(points_m[i], middle_m) > apart_m(points_m[apex], middle_m)) apex = i;
    if (turns.empty() || turns.back() < apex) turns.push_back(apex);
  }
  return turns;
}

/// Appends the curve along some waypoints, after a turn in place to its heading. On failure, the number of
/// the waypoint that prevents it counts from the first of these.
std::optional<WaypointDefect> append_stretch(const std::vector<Point2>& points_m, bool dense,
                                             double tolerance_m, Path& path) {
  Path stretch;
  if (points_m.size() == 2) {
    stretch = blended_polyline(points_m, {0.0, 0.0});
  } else {
    SmoothingSpline spline;
    if (dense)
      spline = smoothing_spline(points_m, tolerance_m);
    else
      spline.curves_m = spline_m(points_m);
    if (spline.deviation_m > tolerance_m && dense)
      return WaypointDefect{spline.worst, false,
                            metres(spline.deviation_m) + " beside the nearest smooth curve",
                            "waypoints that a curve can follow within " + metres(tolerance_m)};
    std::vector<CurveSegment> segments;
    for (std::size_t i = 0; i < spline.curves_m.size(); ++i) {
      if (const auto defects = bezier_defects(spline.curves_m[i], i); !defects.empty())
        return WaypointDefect{dense ? 0 : i + 1, false, defects.front().message,
                              "waypoints that a smooth curve can follow"};
      segments.push_back(BezierSegment(spline.curves_m[i]));
    }
    stretch.pieces.push_back(Curve(std::move(segments)));
  }
  if (!path.pieces.empty()) append_turn_to(path, {}, stretch.start().heading_rad);
  for (PathPiece& piece : stretch.pieces) path.pieces.push_back(std::move(piece));
  return std::nullopt;
}

}  // namespace

WaypointPath curve_through(const std::vector<Point2>& waypoints_m, double tolerance_m) {
  const bool dense = are_dense(waypoints_m, tolerance_m);
  std::vector<Point2> points_m;
  std::vector<std::size_t> number;  // of a point among the waypoints
  for (std::size_t i = 0; i < waypoints_m.size(); ++i) {
    const Point2& here = waypoints_m[i];
    if (dense && i > 0 &&
        std::hypot(here[0] - points_m.back()[0], here[1] - points_m.back()[1]) <= kSamePlace_m)
      continue;
    points_m.push_back(here);
    number.push_back(i);
  }
  if (auto defect = senseless(points_m, dense ? kSamePlace_m : kRounding_m))
    return {.defect = std::move(defect)};
  std::vector<std::size_t> ends =
      dense ? turning_points_of_dense(points_m, tolerance_m) : turning_points(points_m);
  ends.push_back(points_m.size() - 1);
  WaypointPath along;
  std::size_t first = 0;
  for (const std::size_t last : ends) {
    const auto at = [&](std::size_t i) { return points_m.begin() + static_cast<std::ptrdiff_t>(i); };
    along.defect = append_stretch({at(first), at(last + 1)}, dense, tolerance_m, along.path);
    if (along.defect) {
      along.defect->waypoint = number[first + along.defect->waypoint];
      along.path = {};
      break;
    }
    first = last;
  }
  return along;
}

WaypointPath lines_between(const std::vector<Point2>& waypoints_m, const std::vector<double>& radius_m) {
  if (auto defect = senseless(waypoints_m, kRounding_m)) return {.defect = std::move(defect)};
  if (auto defect = no_radius(radius_m)) return {.defect = std::move(defect)};
  if (auto defect = too_wide(waypoints_m, radius_m)) return {.defect = std::move(defect)};
  return {.path = blended_polyline(waypoints_m, driven_radii_m(waypoints_m, radius_m))};
}

}  // namespace joulepath
