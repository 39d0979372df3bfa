#pragma once

#include <tuple>
#include <type_traits>

#include "planner/nlp/terms/acceleration.hpp"
#include "planner/nlp/terms/battery_power.hpp"
#include "planner/nlp/terms/duration.hpp"
#include "planner/nlp/terms/motor_current.hpp"
#include "planner/nlp/terms/motor_power.hpp"
#include "planner/nlp/terms/motor_voltage.hpp"
#include "planner/nlp/terms/traction.hpp"
#include "planner/nlp/terms/wheel_acceleration.hpp"
#include "planner/nlp/terms/wheel_energy.hpp"
#include "planner/nlp/terms/yaw_acceleration.hpp"

// Method: [Verscheure2009], [HargravesParis1987]
namespace joulepath::nlp {

/// The problem, for squares b_k of the rate at the nodes (b_k >= 0; speed, yaw rate, lateral acceleration
/// and speed caps are bounds on b):
///
///   minimize    sum over segments of  sum_channels E + (1 - eta) z  +  (standby + price) dt   [Energy, Time]
///   subject to  every row of Rows within its bounds, z >= 0, E + z >= 0,  sum dt <= or = duration
using Rows = std::tuple<Acceleration, YawAcceleration, WheelAcceleration, MotorCurrent, MotorVoltage,
                        MotorPower, Traction, BatteryPower>;
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
