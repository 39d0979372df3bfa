#pragma once

#include <array>
#include <cmath>
#include <tuple>

#include "model/effects/effect.hpp"

/// Effects that no robot has, added according to docs/adding_an_effect.md: a plain one, one with a region of
/// the floor, one with a shape parameter.
namespace joulepath {

/// A force against the travel that grows with the yaw rate.
struct CurveDrag {
  double coefficient_N_s_rad{};

  static constexpr EffectInfo info{.name = "curve_drag",
                                   .kind = "resistance",
                                   .stage = Stage::body,
                                   .law = "force coefficient |yaw rate| against the travel",
                                   .validity = "tests",
                                   .source = "-",
                                   .gazebo = "none",
                                   .mujoco = "none",
                                   .sign = Sign::nonnegative,
                                   .needs = {.turns = true}};
  static constexpr auto parameters() {
    return std::array{EffectParameter<CurveDrag>{"coefficient_N_s_rad", "N s/rad", -100, 1000, 5.0,
                                                 "force at 1 rad/s", &CurveDrag::coefficient_N_s_rad}};
  }

  template <class Real>
  BodyLoad<Real> body_load(const BodyContext<Real>& body) const {
    return {coefficient_N_s_rad * body.site.travel_direction * body.site.turn_direction * body.yaw_rate_rad_s,
            Real(0.0)};
  }
};

/// A force in proportion to speed inside a rectangle of the floor.
struct WetFloor {
  double coefficient_N_s_m{};
  double x_min_m{};
  double x_max_m{};
  double y_min_m{};
  double y_max_m{};

  static constexpr EffectInfo info{.name = "wet_floor",
                                   .kind = "floor",
                                   .stage = Stage::body,
                                   .law = "force coefficient v inside the rectangle",
                                   .validity = "tests",
                                   .source = "-",
                                   .gazebo = "none",
                                   .mujoco = "none",
                                   .sign = Sign::nonnegative,
                                   .needs = {.samples = true, .pose = true}};
  static constexpr auto parameters() {
    constexpr double kFar_m = 1e6;
    return std::array{EffectParameter<WetFloor>{"coefficient_N_s_m", "N s/m", -100, 1000, 10.0,
                                                "force at 1 m/s", &WetFloor::coefficient_N_s_m},
                      EffectParameter<WetFloor>{"x_min_m", "m", -kFar_m, kFar_m, 1.0, "west edge",
                                                &WetFloor::x_min_m, ParameterRole::edge},
                      EffectParameter<WetFloor>{"x_max_m", "m", -kFar_m, kFar_m, 1.0, "east edge",
                                                &WetFloor::x_max_m, ParameterRole::edge},
                      EffectParameter<WetFloor>{"y_min_m", "m", -kFar_m, kFar_m, 1.0, "south edge",
                                                &WetFloor::y_min_m, ParameterRole::edge},
                      EffectParameter<WetFloor>{"y_max_m", "m", -kFar_m, kFar_m, 1.0, "north edge",
                                                &WetFloor::y_max_m, ParameterRole::edge}};
  }

  bool contains(double x_m, double y_m) const {
    return x_m >= x_min_m && x_m <= x_max_m && y_m >= y_min_m && y_m <= y_max_m;
  }

  template <class Real>
  BodyLoad<Real> body_load(const BodyContext<Real>& body) const {
    if (!contains(body.site.pose.x_m, body.site.pose.y_m)) return {Real(0.0), Real(0.0)};
    return {coefficient_N_s_m * body.speed_m_s, Real(0.0)};
  }
};

/// A torque that is greatest at one wheel speed, as of a resonance in the gear.
struct GearResonance {
  double torque_Nm{};
  double speed_rad_s{};

  static constexpr EffectInfo info{.name = "gear_resonance",
                                   .kind = "resistance",
                                   .stage = Stage::wheel,
                                   .law = "torque exp(-(|q'|/speed - 1)^2 / 0.02) against the wheel",
                                   .validity = "tests",
                                   .source = "-",
                                   .gazebo = "none",
                                   .mujoco = "none",
                                   .sign = Sign::nonnegative};
  static constexpr std::array kSpeeds_rad_s{2.0, 3.0, 4.5, 6.5};
  static constexpr auto parameters() {
    return std::array{EffectParameter<GearResonance>{"torque_Nm", "N m", -5, 50, 0.2, "at the resonance",
                                                     &GearResonance::torque_Nm},
                      EffectParameter<GearResonance>{
                          "speed_rad_s", "rad/s", 0.1, 100, 4.0, "wheel speed of the resonance",
                          &GearResonance::speed_rad_s, ParameterRole::shape, Yardstick{}, kSpeeds_rad_s}};
  }

  template <class Real>
  Real shaft_torque_Nm(const WheelContext<Real>& wheel) const {
    using std::exp;
    const Real off = wheel.speed_rad_s * wheel.direction / speed_rad_s - 1.0;
    return torque_Nm * wheel.direction * exp(-(off * off) / 0.02);
  }
};

using MoreEffects = std::tuple<CurveDrag, WetFloor, GearResonance>;

}  // namespace joulepath
