#pragma once

#include <array>

#include "model/effects/effect.hpp"

namespace joulepath {

/// The current sensors have a wrong gain.
struct CurrentSensorGain {
  double fraction{};

  static constexpr EffectInfo info{.name = "current_sensor_gain",
                                   .kind = "instruments",
                                   .stage = Stage::instrument,
                                   .law = "reading (1 + fraction), both sides",
                                   .validity = "logs only",
                                   .source = "-",
                                   .gazebo = "sensor gain of the log",
                                   .mujoco = "sensor gain of the log",
                                   .curve = "scaled reading"};
  static constexpr auto parameters() {
    return std::array{EffectParameter<CurrentSensorGain>{
        "fraction", "1", -0.95, 10, 0.03, "relative error of the reading", &CurrentSensorGain::fraction}};
  }

  CurrentReading current_reading(Side) const { return {.gain = 1.0 + fraction}; }
};

}  // namespace joulepath
