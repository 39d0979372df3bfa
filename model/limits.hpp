#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "model/sided.hpp"

// Design: docs/decisions/0101-limits-and-energy.md
namespace joulepath {

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Limits of a motion; an absent limit is infinite. SI units; all values are magnitudes.
struct Limits {
  double speed_m_s{kNoLimit};
  double acceleration_m_s2{kNoLimit};
  double deceleration_m_s2{kNoLimit};
  double lateral_acceleration_m_s2{kNoLimit};
  double yaw_rate_rad_s{kNoLimit};
  double yaw_acceleration_rad_s2{kNoLimit};
  double wheel_acceleration_rad_s2{kNoLimit};
  double jerk_m_s3{kNoLimit};
  double traction_coefficient{kNoLimit};  ///< wheel force / normal load
  double motor_power_W{kNoLimit};         ///< electrical, per motor
  double battery_power_W{kNoLimit};       ///< at the battery's terminals, standby included
  double max_payload_kg{kNoLimit};
  double reverse_speed_m_s{kNoLimit};  ///< a search drives backward only where it is finite
  double battery_voltage_V{kNoLimit};  ///< open-circuit voltage that feeds the motors, see battery_charge.hpp
  double charge_power_W{kNoLimit};     ///< into the battery's terminals
};

/// One row of the table of limits. State is LimitState (model/limit_table.hpp).
template <class State>
struct LimitRow {
  std::string_view key{};          ///< in robot files and relaxations: the name with its unit
  std::string_view name{};         ///< in verdicts, and of the term of the nonlinear program
  std::string_view unit{};         ///< as verdicts print it
  std::string_view meaning{};      ///< one line for the schema
  double Limits::*field{};         ///< the robot's value; null for a rating of the motors
  double State::Motor::*rating{};  ///< each motor's value; null otherwise
  bool in_limits{true};            ///< a key of `limits:`; false: the planner takes it from the battery
  bool by_payload{true};           ///< rows of `limits: by_payload` may change it
  bool may_be_zero{};              ///< a robot with a limit of zero can still be of use
  bool per_wheel{};                ///< `value` depends on the side
  bool of_forces{};  ///< its use depends on the plant's constants, and not on the tracked motion alone
  /// What the limit bounds, at a state; the use of the limit is |value| / limit. Null where the limit does
  /// not concern the motion.
  double (*value)(const State& state, Side side){};
};

/// The limits, in the order of robot files. A new limit is a field of Limits and a row here.
template <class State>
inline constexpr std::array kLimitRows{
    LimitRow<State>{.key = "speed_m_s",
                    .name = "speed",
                    .unit = "m/s",
                    .meaning = "greatest speed",
                    .field = &Limits::speed_m_s,
                    .value = [](const State& x, Side) { return x.motion.speed_m_s; }},
    LimitRow<State>{.key = "acceleration_m_s2",
                    .name = "acceleration",
                    .unit = "m/s^2",
                    .meaning = "greatest gain of speed",
                    .field = &Limits::acceleration_m_s2,
                    .value = [](const State& x, Side) { return std::max(0.0, x.speed_gain_m_s2); }},
    LimitRow<State>{.key = "deceleration_m_s2",
                    .name = "deceleration",
                    .unit = "m/s^2",
                    .meaning = "greatest loss of speed",
                    .field = &Limits::deceleration_m_s2,
                    .value = [](const State& x, Side) { return std::max(0.0, -x.speed_gain_m_s2); }},
    LimitRow<State>{
        .key = "lateral_acceleration_m_s2",
        .name = "lateral_acceleration",
        .unit = "m/s^2",
        .meaning = "speed squared times curvature",
        .field = &Limits::lateral_acceleration_m_s2,
        .may_be_zero = true,
        .value = [](const State& x, Side) { return x.motion.speed_m_s * x.motion.yaw_rate_rad_s; }},
    LimitRow<State>{.key = "yaw_rate_rad_s",
                    .name = "yaw_rate",
                    .unit = "rad/s",
                    .meaning = "greatest turning rate",
                    .field = &Limits::yaw_rate_rad_s,
                    .may_be_zero = true,
                    .value = [](const State& x, Side) { return x.motion.yaw_rate_rad_s; }},
    LimitRow<State>{.key = "yaw_acceleration_rad_s2",
                    .name = "yaw_acceleration",
                    .unit = "rad/s^2",
                    .meaning = "greatest change of turning rate",
                    .field = &Limits::yaw_acceleration_rad_s2,
                    .may_be_zero = true,
                    .value = [](const State& x, Side) { return x.motion.yaw_acceleration_rad_s2; }},
    LimitRow<State>{.key = "wheel_acceleration_rad_s2",
                    .name = "wheel_acceleration",
                    .unit = "rad/s^2",
                    .meaning = "of each wheel",
                    .field = &Limits::wheel_acceleration_rad_s2,
                    .per_wheel = true,
                    .value = [](const State& x, Side side) { return x.wheel_acceleration_rad_s2[side]; }},
    LimitRow<State>{.key = "jerk_m_s3",
                    .name = "jerk",
                    .unit = "m/s^3",
                    .meaning = "greatest change of acceleration",
                    .field = &Limits::jerk_m_s3,
                    .value = [](const State& x, Side) { return x.jerk_m_s3; }},
    LimitRow<State>{
        .key = "traction_coefficient",
        .name = "traction",
        .unit = "1",
        .meaning = "wheel force over normal load",
        .field = &Limits::traction_coefficient,
        .per_wheel = true,
        .of_forces = true,
        .value = [](const State& x, Side side) { return x.wheels[side].contact_force_N / x.normal_load_N; }},
    LimitRow<State>{.key = "motor_power_W",
                    .name = "motor_power",
                    .unit = "W",
                    .meaning = "electrical, per motor",
                    .field = &Limits::motor_power_W,
                    .per_wheel = true,
                    .of_forces = true,
                    .value = [](const State& x, Side side) { return x.wheels[side].power_W; }},
    LimitRow<State>{.key = "battery_power_W",
                    .name = "battery_power",
                    .unit = "W",
                    .meaning = "at the battery's terminals, standby included",
                    .field = &Limits::battery_power_W,
                    .of_forces = true,
                    .value = [](const State& x, Side) { return std::max(0.0, x.battery_power_W); }},
    LimitRow<State>{.key = "reverse_speed_m_s",
                    .name = "reverse_speed",
                    .unit = "m/s",
                    .meaning = "greatest speed in reverse; a search drives backward only where it is stated",
                    .field = &Limits::reverse_speed_m_s,
                    .value = [](const State& x, Side) { return std::max(0.0, -x.motion.speed_m_s); }},
    LimitRow<State>{.key = "max_payload_kg",
                    .name = "max_payload",
                    .unit = "kg",
                    .meaning = "greatest payload",
                    .field = &Limits::max_payload_kg,
                    .by_payload = false,
                    .may_be_zero = true},
    LimitRow<State>{.key = "max_current_A",
                    .name = "motor_current",
                    .unit = "A",
                    .meaning = "of each motor",
                    .rating = &State::Motor::max_current_A,
                    .by_payload = false,
                    .per_wheel = true,
                    .of_forces = true,
                    .value = [](const State& x, Side side) { return x.wheels[side].current_A; }},
    LimitRow<State>{.key = "max_voltage_V",
                    .name = "motor_voltage",
                    .unit = "V",
                    .meaning = "of each motor",
                    .rating = &State::Motor::max_voltage_V,
                    .by_payload = false,
                    .per_wheel = true,
                    .of_forces = true,
                    .value = [](const State& x, Side side) { return x.wheels[side].voltage_V; }},
    LimitRow<State>{.key = "battery_voltage_V",
                    .name = "battery_voltage",
                    .unit = "V",
                    .meaning = "a motor's voltage and what the battery's resistance takes",
                    .field = &Limits::battery_voltage_V,
                    .in_limits = false,
                    .by_payload = false,
                    .per_wheel = true,
                    .of_forces = true,
                    .value = [](const State& x,
                                Side side) { return std::abs(x.wheels[side].voltage_V) + x.battery_sag_V; }},
    LimitRow<State>{.key = "charge_power_W",
                    .name = "charge_power",
                    .unit = "W",
                    .meaning = "into the battery's terminals",
                    .field = &Limits::charge_power_W,
                    .in_limits = false,
                    .by_payload = false,
                    .may_be_zero = true,
                    .of_forces = true,
                    .value = [](const State& x, Side) { return std::max(0.0, -x.battery_power_W); }},
};

}  // namespace joulepath
