#pragma once

#include <array>
#include <cmath>

#include "model/effects/yardsticks.hpp"

// Method: [Armstrong1994]
namespace joulepath {

/// Friction that decreases with speed: a lubricated gear has it in addition to Coulomb friction at low speed.
struct StribeckFriction {
  double torque_Nm{};
  double speed_rad_s{};

  static constexpr EffectInfo info{.name = "stribeck_friction",
                                   .kind = "resistance",
                                   .stage = Stage::wheel,
                                   .law = "torque exp(-(|q'|/speed)^2) against the wheel",
                                   .validity = "lubricated gears at low speed",
                                   .source = "Stribeck curve, Gaussian form",
                                   .gazebo = "none",
                                   .mujoco = "none",
                                   .sign = Sign::nonnegative};
  static constexpr std::array kSpeeds_rad_s{0.6, 1.0, 1.6, 2.5, 4.0};
  static constexpr auto parameters() {
    return std::array{EffectParameter<StribeckFriction>{
                          "torque_Nm", "N m", -5, 50, 0.1, "at standstill, in addition to Coulomb friction",
                          &StribeckFriction::torque_Nm, ParameterRole::strength, kResistingTorque},
                      EffectParameter<StribeckFriction>{"speed_rad_s",
                                                        "rad/s",
                                                        0.01,
                                                        100,
                                                        1.0,
                                                        "wheel speed over which it fades",
                                                        &StribeckFriction::speed_rad_s,
                                                        ParameterRole::shape,
                                                        {},
                                                        kSpeeds_rad_s}};
  }

  template <class Real>
  Real shaft_torque_Nm(const WheelContext<Real>& wheel) const {
    using std::exp;
    const Real ratio = wheel.speed_rad_s / speed_rad_s;
    return torque_Nm * wheel.direction * exp(-(ratio * ratio));
  }
};

}  // namespace joulepath
