#pragma once

#include <array>

#include "model/effects/yardsticks.hpp"

namespace joulepath {

/// The standby power differs from the robot file.
struct StandbyPowerError {
  double power_W{};

  static constexpr EffectInfo info{.name = "standby_power_error",
                                   .kind = "electrical",
                                   .stage = Stage::supply,
                                   .law = "standby + power",
                                   .validity = "any",
                                   .source = "-",
                                   .gazebo = "none",
                                   .mujoco = "none",
                                   .needs = {.battery = true}};
  static constexpr auto parameters() {
    return std::array{EffectParameter<StandbyPowerError>{
        "power_W", "W", -10000.0, 100000.0, 2.0, "change of the standby power", &StandbyPowerError::power_W,
        ParameterRole::strength, kStandby}};
  }

  void adjust(Robot& robot) const { robot.power.standby_W += power_W; }
};

}  // namespace joulepath
