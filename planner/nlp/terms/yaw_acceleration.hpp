#pragma once

#include "planner/motion/path_motion.hpp"
#include "planner/nlp/terms/term.hpp"

namespace joulepath::nlp {

/// omega' = kappa a + kappa' b.
struct YawAcceleration {
  static constexpr std::string_view name = "yaw_acceleration";
  static constexpr std::size_t rows = kLimitPoints;
  Limits limits{};

  Bounds bounds(const Segment&, std::size_t) const { return within(limits.yaw_acceleration_rad_s2); }
  template <class AnyInterval>
  auto operator()(const AnyInterval& interval, std::size_t row) const {
    const PathRates& rates = interval.segment.limit_points[row].rates;
    const auto motion = interval.at_limit_point(row);
    return rates.turn * motion.a + rates.turn_slope * motion.b;
  }
};

}  // namespace joulepath::nlp
