#pragma once

#include <array>

#include "model/effects/yardsticks.hpp"

namespace joulepath {

/// A drive has more friction backward than forward: a worm gear, a directional brush.
struct DirectionDependentFriction {
  double reverse_torque_Nm{};

  static constexpr EffectInfo info{.name = "direction_dependent_friction",
                                   .kind = "resistance",
                                   .stage = Stage::wheel,
                                   .law = "torque on a wheel only while it turns backward",
                                   .validity = "as Coulomb friction",
                                   .source = "[P1, Eq. (14)], made one-sided",
                                   .gazebo = "none",
                                   .mujoco = "none",
                                   .sign = Sign::nonnegative,
                                   .needs = {.reversing = true}};
  static constexpr auto parameters() {
    return std::array{EffectParameter<DirectionDependentFriction>{
        "reverse_torque_Nm", "N m", -50, 50, 0.05, "extra friction torque of a wheel turning backward",
        &DirectionDependentFriction::reverse_torque_Nm, ParameterRole::strength, kResistingTorque}};
  }

  template <class Real>
  Real shaft_torque_Nm(const WheelContext<Real>& wheel) const {
    return Real(wheel.direction < 0 ? reverse_torque_Nm * wheel.direction : 0.0);
  }
};

}  // namespace joulepath
