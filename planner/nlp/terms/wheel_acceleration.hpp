#pragma once

#include "planner/nlp/terms/term.hpp"

namespace joulepath::nlp {

/// q'' = g a + g' b with g the wheel's angle per unit of the path, g = (along +/- l turn)/r.
struct WheelAcceleration {
  static constexpr std::string_view name = "wheel_acceleration";
  static constexpr std::size_t rows = kSidedRows;
  Limits limits{};

  Bounds bounds(const Segment&, std::size_t) const { return within(limits.wheel_acceleration_rad_s2); }
  template <class AnyInterval>
  auto operator()(const AnyInterval& interval, std::size_t row) const {
    const SegmentPoint& point = interval.segment.limit_points[point_of(row)];
    const Geometry& geometry = interval.segment.plant->robot.geometry;
    const Side side = side_of(row);
    const double across_m = side_sign(side) * geometry.half_track_m, r_m = geometry.wheel_radius_m[side];
    const double g = (point.rates.along + across_m * point.rates.turn) / r_m;
    const double g_slope = across_m * point.rates.turn_slope / r_m;
    const auto motion = interval.at_limit_point(point_of(row));
    return g * motion.a + g_slope * motion.b;
  }
};

}  // namespace joulepath::nlp
