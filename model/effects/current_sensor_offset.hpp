#pragma once

#include <array>

#include "model/effects/effect.hpp"

namespace joulepath {

/// One current sensor is off by a constant.
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
                                   .mujoco = "sensor bias of the log"};
  static constexpr auto parameters() {
    return std::array{EffectParameter<CurrentSensorOffset>{"offset_A", "A", -100, 100, 0.05,
                                                           "added to the reading of that side",
                                                           &CurrentSensorOffset::offset_A}};
  }

  void distort(Trajectory& log) const {
    for (double& current_A : log.motor_current_A[side]) current_A += offset_A;
  }
};

}  // namespace joulepath
