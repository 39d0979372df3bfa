#include "planner/path/geometry/linear_curvature.hpp"

#include <algorithm>
#include <cmath>

#include "model/assert.hpp"
#include "planner/path/geometry/quadrature.hpp"

namespace joulepath {
namespace {
constexpr double kArcTurn_rad = 0.5;
}

LinearCurvature::LinearCurvature(const Pose& start, double length_m, double curvature_per_m,
                                 double curvature_slope_per_m2)
    : start_(start), length_m_(length_m), curvature_(curvature_per_m), slope_(curvature_slope_per_m2) {
  JOULEPATH_ASSERT(std::isfinite(length_m) && length_m > 0, "a curve segment needs a positive length");
  if (slope_ == 0) return;
  const double worst_curvature = std::max(std::abs(curvature_), std::abs(curvature_ + slope_ * length_m_));
  const int count = std::max(1, static_cast<int>(std::ceil(worst_curvature * length_m_ / kArcTurn_rad)));
  cell_m_ = length_m_ / count;
  cells_.reserve(static_cast<std::size_t>(count));
  cells_.push_back(start_);
  for (int i = 1; i < count; ++i) cells_.push_back(advance(cells_.back(), (i - 1) * cell_m_, i * cell_m_));
}

Pose LinearCurvature::advance(const Pose& from, double from_s_m, double to_s_m) const {
  const auto x_rate = [this](double s_m) { return std::cos(heading_rad(s_m)); };
  const auto y_rate = [this](double s_m) { return std::sin(heading_rad(s_m)); };
  return {from.x_m + integrate_gauss8(x_rate, from_s_m, to_s_m),
          from.y_m + integrate_gauss8(y_rate, from_s_m, to_s_m), heading_rad(to_s_m)};
}

PathPoint LinearCurvature::at(double s_m) const {
  PathPoint point{{}, curvature_ + slope_ * s_m, slope_};
  if (slope_ != 0) {
    const auto last = static_cast<double>(cells_.size() - 1);
    const double cell = std::clamp(std::floor(s_m / cell_m_), 0.0, last);
    point.pose = advance(cells_[static_cast<std::size_t>(cell)], cell * cell_m_, s_m);
    return point;
  }
  // An arc's chord: length s sinc(turn / 2) at the mean heading; a straight line where the turn is 0.
  const double half_turn = 0.5 * curvature_ * s_m, mean_heading = start_.heading_rad + half_turn;
  const double chord_m = half_turn == 0 ? s_m : s_m * std::sin(half_turn) / half_turn;
  point.pose = {start_.x_m + chord_m * std::cos(mean_heading), start_.y_m + chord_m * std::sin(mean_heading),
                heading_rad(s_m)};
  return point;
}

}  // namespace joulepath
