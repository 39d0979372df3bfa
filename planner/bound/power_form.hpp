#pragma once

#include <array>
#include <string>
#include <vector>

#include "model/plant.hpp"

// Design: docs/nlp.md, "What the bound over all paths means"
namespace joulepath {

/// One wheel in a sector of motions, at the wheel-scale speed m >= 0 (m/s) and the share x in [0, 1]:
///   current  i = i0 + m (b0 + b1 x) + m^2 (d0 + d1 x + d2 x^2) + of_a a + of_alpha alpha      (A)
///   speed    s = m (s0 + s1 x)                                                             (rad/s)
///   power    P = R i^2 + K s i                                                               (W)
struct WheelForm {
  double i0{}, b0{}, b1{}, d0{}, d1{}, d2{};
  double of_a{}, of_alpha{};
  double s0{}, s1{};
  double resistance_ohm{}, volts_per_speed{};
};

/// Motions whose wheels turn in one direction each. A sector covers a triangle of speeds:
///   rolling: |v| = m, l |omega| = m x;     turning: |v| = m x, l |omega| = m.
/// A line sector has x at one value, where a wheel stands still or the robot does not turn or not travel.
struct Sector {
  bool turning{};
  double travel{};  ///< sign of the speed
  double turn{};    ///< sign of the yaw rate
  double x_low{}, x_high{1};
  bool mirrored{};  ///< takes what another sector takes, with the opposite yaw rate
  Sided<WheelForm> wheel{};
};

/// The electrical power of a robot at one payload as a function of its motion alone:
///   L = standby + sum max(P, eta P), with P quadratic in the currents of WheelForm.
/// The speed is |v| and the acceleration a = d|v|/dt, so driving forward and in reverse look alike.
struct PowerForm {
  std::vector<Sector> sectors{};
  double half_track_m{};
  double standby_W{};
  double regeneration{};       ///< eta
  bool shared{};               ///< the sum of the powers is recovered, not each
  bool reverse{};              ///< the robot may drive backward
  double yaw_inertia_kg_m2{};  ///< credited to a turning robot: any value gives a valid bound
  Limits limits{};
  std::string not_covered{};  ///< reason why there is no such form; empty if there is one
};

/// The power of a plant, from pointwise evaluations of the model: each form is fitted at eight motions of its
/// sector and compared with the model at others, at random places, times and memories of the effects. An
/// effect whose power has another form, or that acts on a part of the floor, is named in `not_covered`. The
/// driver's voltage drop is left out, which lowers the power; a negative one is not covered.
[[nodiscard]] PowerForm power_form(const Plant& plant, const Limits& limits, double payload_kg);

}  // namespace joulepath
