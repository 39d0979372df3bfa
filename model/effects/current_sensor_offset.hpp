#pragma once

#include <array>

#include "model/effects/yardsticks.hpp"

namespace joulepath {

/// One current sensor has a constant offset.
struct CurrentSensorOffset {
  Side side{};
  double offset_A{};

  static constexpr EffectInfo info{.name = "current_sensor_offset",
                                   .kind = "instruments",
                                   .stage = Stage::instrument,
                                   .law = "reading + offset on one side",
                                   .validity = "logs only",
                                   .source = "-",
                                   .gazebo = "sensor bias of the log",
                                   .mujoco = "sensor bias of the log",
                                   .curve = "shifted reading"};
  static constexpr auto parameters() {
    return std::array{EffectParameter<CurrentSensorOffset>{
        "offset_A", "A", -100, 100, 0.05, "added to the reading of that side", &CurrentSensorOffset::offset_A,
        ParameterRole::strength, kResistingCurrent}};
  }

  CurrentReading current_reading(Side of) const { return {.offset_A = of == side ? offset_A : 0.0}; }
};

}  // namespace joulepath
