#pragma once

// Direct collocation of a speed profile on a known path. u = ds/dt is the rate of the path coordinate s (arc
// length, or the angle of a turn in place), a its acceleration. docs/nlp.md explains this table.
//
//                     without a jerk limit                       with one (jerk_program.hpp)
//   state             b = u^2 at the nodes of s                  u and a at the nodes
//   control           a, constant on each segment                jerk, constant on each segment
//   dynamics          db/ds = 2 a, exact: b is linear in s       du/dt = a, da/dt = jerk, ds/dt = u, exact
//   eliminated        a = (b1 - b0)/(2 ds), dt = 2 ds/(u0 + u1)  jerk = (a1 - a0)/dt
//   unknowns          b at the inner nodes                       u, a at the inner nodes; dt of each segment
//   dynamics' rows    none                                       two per segment: speed, distance
//   path constraints  bounds on b at the nodes; rows at both     bounds on u and a at the nodes; the same
//                     ends and the middle of each segment        rows; jerk; the cap between nodes
//   quadrature        two Gauss-Legendre points in time per segment, exact for powers up to t^3
//   order             2 in the number of segments, where no limit is active; 2 at least with jerk
//
// Why b: the dynamics are linear in it and finite at rest, so a and dt have closed forms. Jerk has none in b.
//
// Method: [Verscheure2009], [HargravesParis1987]

#include <tuple>
#include <type_traits>

#include "planner/nlp/terms/acceleration.hpp"
#include "planner/nlp/terms/battery_power.hpp"
#include "planner/nlp/terms/battery_voltage.hpp"
#include "planner/nlp/terms/charge_power.hpp"
#include "planner/nlp/terms/duration.hpp"
#include "planner/nlp/terms/motor_current.hpp"
#include "planner/nlp/terms/motor_power.hpp"
#include "planner/nlp/terms/motor_voltage.hpp"
#include "planner/nlp/terms/traction.hpp"
#include "planner/nlp/terms/wheel_acceleration.hpp"
#include "planner/nlp/terms/wheel_energy.hpp"
#include "planner/nlp/terms/yaw_acceleration.hpp"

namespace joulepath::nlp {

/// The problem, for squares b_k of the rate at the nodes (b_k >= 0; speed, yaw rate, lateral acceleration
/// and speed caps are bounds on b):
///
///   minimize    sum over segments of  sum_channels E + (1 - eta) z  +  (standby + price) dt   [Energy, Time]
///   subject to  every row of Rows within its bounds, z >= 0, E + z >= 0,  sum dt <= or = duration
using Rows = std::tuple<Acceleration, YawAcceleration, WheelAcceleration, MotorCurrent, MotorVoltage,
                        MotorPower, Traction, BatteryPower, BatteryVoltage, ChargePower>;
/// The three accelerations come first and are linear in b.
inline constexpr std::size_t kYawTerm = 1, kLastLinearTerm = 2;
static_assert(std::is_same_v<std::tuple_element_t<kYawTerm, Rows>, YawAcceleration> &&
              std::is_same_v<std::tuple_element_t<kLastLinearTerm, Rows>, WheelAcceleration>);
template <class... Terms>
constexpr std::size_t rows_of(const std::tuple<Terms...>*) {
  return (Terms::rows + ...);
}
/// Of one segment, at most.
inline constexpr std::size_t kMostRows = rows_of(static_cast<const Rows*>(nullptr));
using Energy = WheelEnergy;
using Time = Duration;

/// Gives a term the limits if it has them as a member.
template <class Term>
Term term_for(const Limits& limits) {
  if constexpr (requires { Term{limits}; })
    return Term{limits};
  else
    return Term{};
}
template <class... Terms>
std::tuple<Terms...> terms_for(const Limits& limits, std::type_identity<std::tuple<Terms...>>) {
  return {term_for<Terms>(limits)...};
}
inline Rows rows_for(const Limits& limits) { return terms_for(limits, std::type_identity<Rows>{}); }

template <class... Terms>
constexpr bool all_are_terms(const std::tuple<Terms...>*) {
  return (SegmentTerm<Terms> && ...);
}
static_assert(all_are_terms(static_cast<const Rows*>(nullptr)));

}  // namespace joulepath::nlp
