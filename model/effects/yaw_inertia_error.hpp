#pragma once

#include <array>

#include "model/effects/effect.hpp"

namespace joulepath {

/// The chassis resists yaw acceleration more than the robot file says.
struct YawInertiaError {
  double fraction{};

  static constexpr EffectInfo info{.name = "yaw_inertia_error",
                                   .kind = "mass and geometry",
                                   .stage = Stage::parameters,
                                   .law = "I_c (1 + fraction)",
                                   .validity = "any",
                                   .source = "[P1, Eq. (12)]",
                                   .gazebo = "<inertial><inertia><izz>",
                                   .mujoco = "diaginertia of the chassis body",
                                   .pliability = Pliability::anywhere,
                                   .needs = {.turns = true}};
  static constexpr auto parameters() {
    return std::array{EffectParameter<YawInertiaError>{"fraction", "1", -0.95, 10, 0.1,
                                                       "relative error of the chassis yaw inertia",
                                                       &YawInertiaError::fraction}};
  }

  void adjust(Robot& robot) const { robot.inertia.chassis_yaw_inertia_kg_m2 *= 1.0 + fraction; }
};

}  // namespace joulepath
