#pragma once

#include "planner/nlp/terms/motor_rating.hpp"

namespace joulepath::nlp {

struct VoltageRating {
  static constexpr std::string_view name = "motor_voltage";
  static constexpr double Motor::*rating = &Motor::max_voltage_V;
  template <class Load>
  static auto of(const Load& load) {
    return load.voltage_V;
  }
};

/// |R i + Kv n q'| <= V_max, per wheel. Concave in b where the wheel drives.  [P1, Eq. (15)]
using MotorVoltage = MotorRating<VoltageRating>;

}  // namespace joulepath::nlp
