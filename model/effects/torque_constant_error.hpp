#pragma once

#include <array>

#include "model/effects/effect.hpp"

namespace joulepath {

/// The magnets are weaker or stronger than the data sheet says.
struct TorqueConstantError {
  double fraction{};

  static constexpr EffectInfo info{.name = "torque_constant_error",
                                   .kind = "electrical",
                                   .stage = Stage::parameters,
                                   .law = "Kt and Kv (1 + fraction)",
                                   .validity = "any",
                                   .source = "[P1, Eq. (14)]",
                                   .gazebo = "none",
                                   .mujoco = "gear of the motor actuator"};
  static constexpr auto parameters() {
    return std::array{EffectParameter<TorqueConstantError>{"fraction", "1", -0.9, 5, 0.02,
                                                           "relative error of Kt and Kv together",
                                                           &TorqueConstantError::fraction}};
  }

  void adjust(Robot& robot) const {
    for (Motor* motor : {&robot.motor.left, &robot.motor.right}) {
      motor->torque_constant_Nm_A *= 1.0 + fraction;
      motor->voltage_constant_V_s_rad *= 1.0 + fraction;
    }
  }
};

}  // namespace joulepath
