#include "planner/path/geometry/direction_segment.hpp"

#include <algorithm>
#include <cmath>

#include "model/assert.hpp"
#include "planner/path/geometry/quadrature.hpp"

namespace joulepath {
namespace {
constexpr double kCellTurn_rad = 0.5;
}

DirectionSegment::DirectionSegment(const Pose& start, const Shape& shape)
    : start_(start),
      shape_(shape),
      along_(std::cos(shape.from_rad)),
      along_change_(std::cos(shape.to_rad) - along_),
      across_(std::sin(shape.from_rad)),
      across_change_(std::sin(shape.to_rad) - across_),
      arc_m_(shape.length_m * (along_ + 0.5 * along_change_)) {
  JOULEPATH_ASSERT(
      std::isfinite(shape.length_m) && shape.length_m > 0 && along_ > 0 && along_ + along_change_ > 0,
      "a direction segment drives forward along its tangent");
  const double most_rad =
      std::max(std::abs(across_), std::abs(across_ + across_change_)) * shape.length_m / shape.half_track_m;
  const int count = std::max(1, static_cast<int>(std::ceil(most_rad / kCellTurn_rad)));
  cells_.reserve(static_cast<std::size_t>(count));
  cells_.push_back(start_);
  for (int i = 1; i < count; ++i)
    cells_.push_back(advance(cells_.back(), (i - 1.0) / count, static_cast<double>(i) / count));
}

/// The root of s = l (A0 f + dA f^2 / 2), written without cancellation.
double DirectionSegment::share(double s_m) const {
  const double s = s_m / shape_.length_m, square = along_ * along_ + 2 * along_change_ * s;
  return std::clamp(2 * s / (along_ + std::sqrt(std::max(0.0, square))), 0.0, 1.0);
}

double DirectionSegment::heading_rad(double f) const {
  return start_.heading_rad +
         shape_.length_m / shape_.half_track_m * f * (across_ + 0.5 * across_change_ * f);
}

Pose DirectionSegment::advance(const Pose& from, double from_f, double to_f) const {
  const auto along_m = [this](double f) { return shape_.length_m * (along_ + along_change_ * f); };
  const auto x_rate = [&](double f) { return along_m(f) * std::cos(heading_rad(f)); };
  const auto y_rate = [&](double f) { return along_m(f) * std::sin(heading_rad(f)); };
  return {from.x_m + integrate_gauss8(x_rate, from_f, to_f),
          from.y_m + integrate_gauss8(y_rate, from_f, to_f), heading_rad(to_f)};
}

Pose DirectionSegment::pose(double f) const {
  const auto count = static_cast<double>(cells_.size());
  const double cell = std::clamp(std::floor(f * count), 0.0, count - 1);
  return advance(cells_[static_cast<std::size_t>(cell)], cell / count, f);
}

PathBend DirectionSegment::bend(double s_m) const {
  const double f = share(s_m), A = along_ + along_change_ * f, B = across_ + across_change_ * f;
  const double rho = shape_.half_track_m;
  return {B / (rho * A), (across_change_ * A - B * along_change_) / (rho * A * A * A * shape_.length_m)};
}

PathPoint DirectionSegment::at(double s_m) const {
  const PathBend here = bend(s_m);
  return {pose(share(s_m)), here.curvature_per_m, here.curvature_slope_per_m2};
}

std::array<double, 2> DirectionSegment::position_m(double s_m) const {
  const Pose here = pose(share(s_m));
  return {here.x_m, here.y_m};
}

double DirectionSegment::curvature_bound_per_m() const {
  return std::max(std::abs(bend(0).curvature_per_m), std::abs(bend(arc_m_).curvature_per_m));
}

}  // namespace joulepath
