#pragma once

#include <array>

#include "model/effects/effect.hpp"

namespace joulepath {

/// The gear loses a fraction of the torque that it transmits, in both directions of power.
struct GearEfficiency {
  double loss_fraction{};

  static constexpr EffectInfo info{.name = "gear_efficiency",
                                   .kind = "resistance",
                                   .stage = Stage::gear,
                                   .law = "torque loss_fraction |Kt n i| against the wheel's motion",
                                   .validity = "loss_fraction < 1; running gears",
                                   .source = "constant-efficiency gear",
                                   .gazebo = "none",
                                   .mujoco = "none",
                                   .sign = Sign::nonnegative,
                                   .curve = "loss by torque"};
  static constexpr auto parameters() {
    return std::array{EffectParameter<GearEfficiency>{
        "loss_fraction", "1", -0.5, 0.9, 0.05, "of the transmitted torque", &GearEfficiency::loss_fraction}};
  }

  double torque_loss_fraction() const { return loss_fraction; }
};

}  // namespace joulepath
