#include "planner/path/geometry/quintic_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planner/path/geometry/path.hpp"

namespace joulepath {
namespace {

constexpr int kLooks = 16;
constexpr int kDeepestFit = 12;
constexpr double kTurned_rad = 1e-3;

/// Heading of the tangent: the robot's, turned by pi in reverse.
double tangent_rad(const Curve& curve, const PathPoint& point) {
  return point.pose.heading_rad + (curve.direction() == Direction::reverse ? std::numbers::pi : 0.0);
}

/// The quintic whose derivatives by t at both ends are length T and length^2 kappa N.
RationalBezier quintic(const Curve& curve, double from_m, double to_m) {
  const double length_m = to_m - from_m;
  RationalBezier fit;
  fit.points.resize(6);
  const auto end = [&](const PathPoint& point, std::size_t at, std::ptrdiff_t step) {
    const double heading_rad = tangent_rad(curve, point), c = std::cos(heading_rad),
                 s = std::sin(heading_rad);
    const double sign = static_cast<double>(step), bend = length_m * length_m * point.curvature_per_m / 20;
    const double x = point.pose.x_m, y = point.pose.y_m, reach_m = sign * length_m / 5;
    const auto index = static_cast<std::ptrdiff_t>(at);
    const auto place = [&](std::ptrdiff_t k) -> RationalBezier::Point& {
      return fit.points[static_cast<std::size_t>(index + k * step)];
    };
    place(0) = {x, y, 1};
    place(1) = {x + reach_m * c, y + reach_m * s, 1};
    place(2) = {x + 2 * reach_m * c - bend * s, y + 2 * reach_m * s + bend * c, 1};
  };
  end(curve.at(from_m), 0, 1);
  end(curve.at(to_m), 5, -1);
  return fit;
}

/// Whether the fit stays beside the curve and as turned as it, at equal shares of their lengths.
bool follows(const RationalBezier& fit, const Curve& curve, double from_m, double to_m, double tolerance_m) {
  const BezierSegment segment = BezierSegment::rational(fit);
  for (int i = 1; i < kLooks; ++i) {
    const PathPoint wanted = curve.at(from_m + (to_m - from_m) * i / kLooks);
    const Pose found = segment.at(segment.length_m() * i / kLooks).pose;
    if (std::hypot(found.x_m - wanted.pose.x_m, found.y_m - wanted.pose.y_m) > tolerance_m) return false;
    if (std::abs(wrapped_angle_rad(found.heading_rad - tangent_rad(curve, wanted))) > kTurned_rad)
      return false;
  }
  return true;
}

void append(const Curve& curve, double from_m, double to_m, double tolerance_m, int depth,
            std::vector<RationalBezier>& out) {
  RationalBezier fit = quintic(curve, from_m, to_m);
  if (depth == kDeepestFit || follows(fit, curve, from_m, to_m, tolerance_m)) {
    out.push_back(std::move(fit));
    return;
  }
  const double middle_m = 0.5 * (from_m + to_m);
  append(curve, from_m, middle_m, tolerance_m, depth + 1, out);
  append(curve, middle_m, to_m, tolerance_m, depth + 1, out);
}

}  // namespace

std::vector<RationalBezier> quintic_fit(const Curve& curve, double from_m, double to_m, double tolerance_m) {
  std::vector<RationalBezier> pieces;
  append(curve, from_m, to_m, tolerance_m, 0, pieces);
  return pieces;
}

}  // namespace joulepath
