#pragma once

#include "planner/nlp/terms/term.hpp"

namespace joulepath::nlp {

/// |i| <= i_max, per wheel.                                                  [P1, Eq. (14)]
struct MotorCurrent {
  static constexpr std::string_view name = "motor_current";
  static constexpr std::size_t rows = kSidedRows;

  Bounds bounds(const Segment& segment, std::size_t row) const {
    return within(segment.plant->robot.motor[side_of(row)].max_current_A);
  }
  template <class Real>
  Real operator()(const Interval<Real>& interval, std::size_t row) const {
    return load_at(interval, point_of(row), side_of(row)).current_A;
  }
};

}  // namespace joulepath::nlp
