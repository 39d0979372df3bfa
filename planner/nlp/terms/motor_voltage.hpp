#pragma once

#include "planner/nlp/terms/term.hpp"

namespace joulepath::nlp {

/// |R i + Kv n q'| <= V_max, per wheel. Concave in b where the wheel drives.  [P1, Eq. (15)]
struct MotorVoltage {
  static constexpr std::string_view name = "motor_voltage";
  static constexpr std::size_t rows = kSidedRows;

  Bounds bounds(const Segment& segment, std::size_t row) const {
    return within(segment.plant->robot.motor[side_of(row)].max_voltage_V);
  }
  template <class Real>
  Real operator()(const Interval<Real>& interval, std::size_t row) const {
    return load_at(interval, point_of(row), side_of(row)).voltage_V;
  }
};

}  // namespace joulepath::nlp
