#pragma once

#include <array>

#include "model/effects/effect.hpp"

namespace joulepath {

/// Both wheels are larger than the robot file says: other tires, another load.
struct WheelRadiusError {
  double fraction{};

  static constexpr EffectInfo info{.name = "wheel_radius_error",
                                   .kind = "mass and geometry",
                                   .stage = Stage::parameters,
                                   .law = "both radii (1 + fraction)",
                                   .validity = "any",
                                   .source = "[P1, Eqs. (2), (3)]",
                                   .gazebo = "<radius> of the wheel collision",
                                   .mujoco = "size of the wheel geoms",
                                   .needs = {.pose = true}};
  static constexpr auto parameters() {
    return std::array{EffectParameter<WheelRadiusError>{
        "fraction", "1", -0.5, 1, 0.01, "relative error of both radii", &WheelRadiusError::fraction}};
  }

  void adjust(Robot& robot) const {
    robot.geometry.wheel_radius_m.left *= 1.0 + fraction;
    robot.geometry.wheel_radius_m.right *= 1.0 + fraction;
  }
};

}  // namespace joulepath
