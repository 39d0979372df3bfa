#pragma once

#include <array>

#include "model/effects/effect.hpp"

namespace joulepath {

/// The supply voltage drops under load: an old battery, thin cables.
struct SupplySag {
  double resistance_ohm{};

  static constexpr EffectInfo info{.name = "supply_sag",
                                   .kind = "electrical",
                                   .stage = Stage::supply,
                                   .law = "the supply's internal resistance is resistance_ohm",
                                   .validity = "steady loads",
                                   .source = "battery as a source with internal resistance",
                                   .gazebo = "a battery plugin with <resistance>",
                                   .mujoco = "none",
                                   .needs = {.battery = true}};
  static constexpr auto parameters() {
    return std::array{EffectParameter<SupplySag>{"resistance_ohm", "ohm", 0.0, 100, 0.1,
                                                 "total internal resistance, in place of the robot file's",
                                                 &SupplySag::resistance_ohm}};
  }

  static double in_robot_file(const Robot& robot) { return robot.battery.internal_resistance_ohm; }
  void adjust(Robot& robot) const { robot.battery.internal_resistance_ohm = resistance_ohm; }
};

}  // namespace joulepath
