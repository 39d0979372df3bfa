#pragma once

#include <array>

#include "model/effects/effect.hpp"

// Method: [Borenstein1996]
namespace joulepath {

/// The wheels differ: one tire is worn. The robot pulls to the side of the smaller wheel.
struct WheelRadiusMismatch {
  double fraction{};

  static constexpr EffectInfo info{.name = "wheel_radius_mismatch",
                                   .kind = "mass and geometry",
                                   .stage = Stage::parameters,
                                   .law = "left radius (1 + fraction/2), right radius (1 - fraction/2)",
                                   .validity = "any",
                                   .source = "UMBmark (Borenstein and Feng)",
                                   .gazebo = "<radius> of one wheel collision",
                                   .mujoco = "size of one wheel geom"};
  static constexpr auto parameters() {
    return std::array{EffectParameter<WheelRadiusMismatch>{
        "fraction", "1", -0.5, 0.5, 0.005, "left minus right, relative", &WheelRadiusMismatch::fraction}};
  }

  void adjust(Robot& robot) const {
    robot.geometry.wheel_radius_m.left *= 1.0 + fraction / 2;
    robot.geometry.wheel_radius_m.right *= 1.0 - fraction / 2;
  }
};

}  // namespace joulepath
