#pragma once

#include <array>

#include "model/effects/effect.hpp"

namespace joulepath {

/// Hysteresis of tire and floor: a torque proportional to the wheel's load.
struct RollingResistance {
  double coefficient{};

  static constexpr EffectInfo info{
      .name = "rolling_resistance",
      .kind = "resistance",
      .stage = Stage::wheel,
      .law = "torque = coefficient N r against the wheel, N = m g / 2",
      .validity = "hard floor, speeds where the coefficient is constant",
      .source = "Coulomb law of rolling friction",
      .gazebo = "none by default; similar: a wheel joint <friction> scaled by load",
      .mujoco = "frictionloss on the wheel joint, scaled by load",
      .sign = Sign::nonnegative};
  static constexpr auto parameters() {
    return std::array{EffectParameter<RollingResistance>{
        "coefficient", "1", -0.05, 0.5, 0.01, "rolling resistance coefficient, times the normal load",
        &RollingResistance::coefficient}};
  }

  template <class Real>
  Real shaft_torque_Nm(const WheelContext<Real>& wheel) const {
    return Real(coefficient * wheel.normal_load_N * wheel.radius_m * wheel.direction);
  }
};

}  // namespace joulepath
