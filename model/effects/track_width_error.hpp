#pragma once

#include <array>

#include "model/effects/effect.hpp"

// Method: [Borenstein1996]
namespace joulepath {

/// The effective track differs from the robot file: the contact point of a wide tire is not at its middle.
struct TrackWidthError {
  double fraction{};

  static constexpr EffectInfo info{.name = "track_width_error",
                                   .kind = "mass and geometry",
                                   .stage = Stage::parameters,
                                   .law = "l (1 + fraction)",
                                   .validity = "any",
                                   .source = "UMBmark (Borenstein and Feng)",
                                   .gazebo = "<wheel_separation> of the drive plugin",
                                   .mujoco = "position of the wheel bodies",
                                   .needs = {.yaw_rate = true, .turns = true}};
  static constexpr auto parameters() {
    return std::array{EffectParameter<TrackWidthError>{
        "fraction", "1", -0.5, 1, 0.02, "relative error of the half track", &TrackWidthError::fraction}};
  }

  void adjust(Robot& robot) const { robot.geometry.half_track_m *= 1.0 + fraction; }
};

}  // namespace joulepath
