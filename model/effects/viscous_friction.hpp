#pragma once

#include <array>

#include "model/effects/effect.hpp"

namespace joulepath {

/// Friction in proportion to speed differs from the robot file.
struct ViscousFriction {
  double coefficient_Nm_s_rad{};

  static constexpr EffectInfo info{.name = "viscous_friction",
                                   .kind = "resistance",
                                   .stage = Stage::parameters,
                                   .law = "nu + coefficient, wheel side",
                                   .validity = "as the motor model",
                                   .source = "[P1, Eq. (14)]",
                                   .gazebo = "<dynamics><damping> of the wheel joint",
                                   .mujoco = "damping of the wheel joint"};
  static constexpr auto parameters() {
    return std::array{EffectParameter<ViscousFriction>{"coefficient_Nm_s_rad", "N m s/rad", -10, 10, 0.005,
                                                       "change of the viscous friction at the wheel",
                                                       &ViscousFriction::coefficient_Nm_s_rad}};
  }

  void adjust(Robot& robot) const {
    robot.motor.left.viscous_friction_Nm_s_rad += coefficient_Nm_s_rad;
    robot.motor.right.viscous_friction_Nm_s_rad += coefficient_Nm_s_rad;
  }
};

}  // namespace joulepath
