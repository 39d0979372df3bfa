#include "planner/path/geometry/curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/assert.hpp"

namespace joulepath {
namespace {

double segment_length_m(const CurveSegment& segment) {
  return std::visit([](const auto& s) { return s.length_m(); }, segment);
}

PathPoint segment_point(const CurveSegment& segment, double s_m) {
  return std::visit([s_m](const auto& s) { return s.at(s_m); }, segment);
}

}  // namespace

Curve::Curve(std::vector<CurveSegment> segments, Direction direction)
    : segments_(std::move(segments)), direction_(direction) {
  JOULEPATH_ASSERT(!segments_.empty(), "a curve needs a segment");
  breakpoints_m_.push_back(0);
  heading_offset_rad_.push_back(direction == Direction::reverse ? std::numbers::pi : 0.0);
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const double length_m = segment_length_m(segments_[i]);
    breakpoints_m_.push_back(breakpoints_m_.back() + length_m);
    if (i + 1 == segments_.size()) break;
    const PathPoint end = segment_point(segments_[i], length_m), next = segment_point(segments_[i + 1], 0);
    const double difference = end.pose.heading_rad - next.pose.heading_rad;
    const double whole_turns = 2 * std::numbers::pi * std::round(difference / (2 * std::numbers::pi));
    heading_offset_rad_.push_back(heading_offset_rad_.back() + whole_turns);
    JOULEPATH_ASSERT(
        std::hypot(end.pose.x_m - next.pose.x_m, end.pose.y_m - next.pose.y_m) <= kPositionTolerance_m,
        "a curve's segments must meet");
    JOULEPATH_ASSERT(std::abs(difference - whole_turns) <= kHeadingTolerance_rad,
                     "a curve's heading must be continuous");
    JOULEPATH_ASSERT(std::abs(end.curvature_per_m - next.curvature_per_m) <= kCurvatureTolerance_per_m,
                     "a curve's curvature must be continuous");
  }
}

std::size_t Curve::segment_at(double s_m) const {
  const auto after = std::upper_bound(breakpoints_m_.begin(), breakpoints_m_.end(), s_m);
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
      after - breakpoints_m_.begin() - 1, 0, static_cast<std::ptrdiff_t>(segments_.size()) - 1));
}

PathBend Curve::bend(double s_m) const {
  const double s = std::clamp(s_m, 0.0, length_m());
  const std::size_t index = segment_at(s);
  return std::visit([&](const auto& segment) { return segment.bend(s - breakpoints_m_[index]); },
                    segments_[index]);
}

std::array<double, 2> Curve::position_m(double s_m) const {
  const double s = std::clamp(s_m, 0.0, length_m());
  const std::size_t index = segment_at(s);
  return std::visit([&](const auto& segment) { return segment.position_m(s - breakpoints_m_[index]); },
                    segments_[index]);
}

PathPoint Curve::at(double s_m) const {
  const double s = std::clamp(s_m, 0.0, length_m());
  const std::size_t index = segment_at(s);
  PathPoint point = segment_point(segments_[index], s - breakpoints_m_[index]);
  point.pose.heading_rad += heading_offset_rad_[index];
  return point;
}

}  // namespace joulepath
