#pragma once

#include <array>

#include "model/effects/effect.hpp"

namespace joulepath {

/// The center of mass lies further forward than the robot file says.
struct CenterOfMassOffset {
  double offset_m{};

  static constexpr EffectInfo info{.name = "center_of_mass_offset",
                                   .kind = "mass and geometry",
                                   .stage = Stage::parameters,
                                   .law = "d = robot file + offset, for chassis and payload together",
                                   .validity = "any",
                                   .source = "[P1, Eqs. (12), (17)]",
                                   .gazebo = "<inertial><pose> of the chassis link",
                                   .mujoco = "inertial pos of the chassis body",
                                   .needs = {.turns = true}};
  static constexpr auto parameters() {
    return std::array{EffectParameter<CenterOfMassOffset>{"offset_m", "m", -1, 1, 0.02,
                                                          "forward of its place in the robot file",
                                                          &CenterOfMassOffset::offset_m}};
  }

  void adjust(Robot& robot) const {
    robot.geometry.center_of_mass_offset_m += offset_m;
    if (robot.payload_offset_m) *robot.payload_offset_m += offset_m;
  }
};

}  // namespace joulepath
