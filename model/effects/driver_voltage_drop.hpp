#pragma once

#include <array>

#include "model/effects/effect.hpp"

namespace joulepath {

/// The driver's output voltage is lower than commanded by a constant drop.
struct DriverVoltageDrop {
  double voltage_V{};

  static constexpr EffectInfo info{.name = "driver_voltage_drop",
                                   .kind = "electrical",
                                   .stage = Stage::driver,
                                   .law = "motor voltage = logged voltage - voltage sign(i)",
                                   .validity = "currents well above the ripple",
                                   .source = "transistor and diode drops of an H-bridge",
                                   .gazebo = "none",
                                   .mujoco = "none",
                                   .sign = Sign::nonnegative,
                                   .curve = "drop by sign"};
  static constexpr auto parameters() {
    return std::array{EffectParameter<DriverVoltageDrop>{"voltage_V", "V", -5, 20, 0.2, "lost in the bridge",
                                                         &DriverVoltageDrop::voltage_V}};
  }

  double voltage_drop_V() const { return voltage_V; }
};

}  // namespace joulepath
