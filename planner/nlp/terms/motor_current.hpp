#pragma once

#include "planner/nlp/terms/motor_rating.hpp"

namespace joulepath::nlp {

struct CurrentRating {
  static constexpr std::string_view name = "motor_current";
  static constexpr double Motor::*rating = &Motor::max_current_A;
  template <class Load>
  static auto of(const Load& load) {
    return load.current_A;
  }
};

/// |i| <= i_max, per wheel.                                                  [P1, Eq. (14)]
using MotorCurrent = MotorRating<CurrentRating>;

}  // namespace joulepath::nlp
