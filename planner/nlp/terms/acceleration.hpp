#pragma once

#include "planner/nlp/terms/term.hpp"

namespace joulepath::nlp {

/// Linear acceleration and deceleration, not the same size:
///   -deceleration <= dv/dt <= acceleration,   dv/dt = (b1 - b0)/(2 ds) along a curve, 0 in a turn in place.
struct Acceleration {
  static constexpr std::string_view name = "acceleration";
  static constexpr std::size_t rows = 1;
  Limits limits{};

  Bounds bounds(const Segment& segment, std::size_t) const {
    if (segment.limit_points[0].rates.along == 0) return {};
    return {-limits.deceleration_m_s2, limits.acceleration_m_s2};
  }
  template <class AnyInterval>
  auto operator()(const AnyInterval& interval, std::size_t) const {
    return interval.at_limit_point(0).a;
  }
};

}  // namespace joulepath::nlp
