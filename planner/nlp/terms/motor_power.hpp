#pragma once

#include "planner/nlp/terms/term.hpp"

namespace joulepath::nlp {

/// |V i| <= P_max, per wheel.                                                [P1, Eq. (28)]
struct MotorPower {
  static constexpr std::string_view name = "motor_power";
  static constexpr std::size_t rows = kSidedRows;
  Limits limits{};

  Bounds bounds(const Segment&, std::size_t) const { return within(limits.motor_power_W); }
  template <class AnyInterval>
  auto operator()(const AnyInterval& interval, std::size_t row) const {
    return load_at(interval, point_of(row), side_of(row)).power_W;
  }
};

}  // namespace joulepath::nlp
