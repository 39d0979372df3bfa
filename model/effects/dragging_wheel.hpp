#pragma once

#include <array>

#include "model/effects/yardsticks.hpp"

namespace joulepath {

/// One drive has additional friction: a dragging brake, a worn bearing, hair around an axle.
struct DraggingWheel {
  Side side{};
  double torque_Nm{};

  static constexpr EffectInfo info{.name = "dragging_wheel",
                                   .kind = "resistance",
                                   .stage = Stage::parameters,
                                   .law = "T_m + torque on one wheel",
                                   .validity = "as the motor model",
                                   .source = "[P1, Eq. (14)]",
                                   .gazebo = "<dynamics><friction> of one wheel joint",
                                   .mujoco = "frictionloss of one wheel joint",
                                   .sign = Sign::nonnegative};
  static constexpr auto parameters() {
    return std::array{EffectParameter<DraggingWheel>{
        "torque_Nm", "N m", -50, 50, 0.05, "change of the friction torque on that side",
        &DraggingWheel::torque_Nm, ParameterRole::strength, kResistingTorque}};
  }

  void adjust(Robot& robot) const { robot.motor[side].friction_torque_Nm += torque_Nm; }
};

}  // namespace joulepath
