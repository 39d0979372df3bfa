#pragma once

#include <array>

#include "model/effects/yardsticks.hpp"

namespace joulepath {

/// Both drives have more (or less) Coulomb friction than the robot file states.
struct CoulombFriction {
  double torque_Nm{};

  static constexpr EffectInfo info{.name = "coulomb_friction",
                                   .kind = "resistance",
                                   .stage = Stage::parameters,
                                   .law = "T_m + torque, both wheels",
                                   .validity = "as the motor model",
                                   .source = "[P1, Eq. (14)]",
                                   .gazebo = "<dynamics><friction> of the wheel joint",
                                   .mujoco = "frictionloss of the wheel joint"};
  static constexpr auto parameters() {
    return std::array{EffectParameter<CoulombFriction>{
        "torque_Nm", "N m", -50, 50, 0.05, "change of the friction torque, both wheels alike",
        &CoulombFriction::torque_Nm, ParameterRole::strength, kResistingTorque}};
  }

  void adjust(Robot& robot) const {
    robot.motor.left.friction_torque_Nm += torque_Nm;
    robot.motor.right.friction_torque_Nm += torque_Nm;
  }
};

}  // namespace joulepath
