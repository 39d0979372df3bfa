#pragma once

#include <array>

#include "model/effects/effect.hpp"

namespace joulepath {

/// The share of the braking energy that the driver returns differs from the robot file.
struct RegenerationError {
  double efficiency{};

  static constexpr EffectInfo info{.name = "regeneration_error",
                                   .kind = "electrical",
                                   .stage = Stage::supply,
                                   .law = "efficiency replaces the robot file's",
                                   .validity = "any",
                                   .source = "-",
                                   .gazebo = "none",
                                   .mujoco = "none",
                                   .sign = Sign::nonnegative,
                                   .needs = {.battery = true}};
  static constexpr auto parameters() {
    return std::array{EffectParameter<RegenerationError>{"efficiency", "1", 0.0, 1.0, 0.5,
                                                         "recovered share of negative motor power",
                                                         &RegenerationError::efficiency}};
  }

  static double in_robot_file(const Robot& robot) { return robot.power.regeneration_efficiency; }
  void adjust(Robot& robot) const { robot.power.regeneration_efficiency = efficiency; }
};

}  // namespace joulepath
