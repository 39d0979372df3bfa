#pragma once

#include "planner/nlp/terms/term.hpp"

namespace joulepath::nlp {

/// omega' = kappa a + kappa' b.
struct YawAcceleration {
  static constexpr std::string_view name = "yaw_acceleration";
  static constexpr std::size_t rows = kLimitPoints;
  Limits limits{};

  Bounds bounds(const Segment&, std::size_t) const { return within(limits.yaw_acceleration_rad_s2); }
  template <class Real>
  Real operator()(const Interval<Real>& interval, std::size_t row) const {
    const PathRates& rates = interval.segment.limit_points[row].rates;
    const double f = interval.segment.limit_points[row].fraction;
    return rates.turn * interval.a + rates.turn_slope * ((1 - f) * interval.b0 + f * interval.b1);
  }
};

}  // namespace joulepath::nlp
