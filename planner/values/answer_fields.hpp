#pragma once

#include "model/energy.hpp"
#include "planner/path/geometry/path_fields.hpp"
#include "planner/values/leg_state.hpp"
#include "planner/values/profile_request.hpp"
#include "planner/values/profile_result.hpp"
#include "planner/values/replay_result.hpp"

// Fields of the cached questions and answers (planner/cache).
namespace joulepath {

template <class Archive>
void each_field(Archive& archive, Infeasibility& value) {
  auto& [constraint, s, x_m, y_m, amount, unit, relaxation, message] = value;
  archive(constraint, s, x_m, y_m, amount, unit, relaxation, message);
}

template <class Archive>
void each_field(Archive& archive, Profile& value) {
  auto& [time_s, s, rate, acceleration, jerk, wait_s] = value;
  archive(time_s, s, rate, acceleration, jerk, wait_s);
}

template <class Archive>
void each_field(Archive& archive, SolveSummary& value) {
  auto& [status, solver, iterations, nodes, price_of_time_W, lower_bound_J, lower_bound_s, gap_percent, local,
         counted_J, handed_over, message] = value;
  archive(status, solver, iterations, nodes, price_of_time_W, lower_bound_J, lower_bound_s, gap_percent,
          local, counted_J, handed_over, message);
}

template <class Archive>
void each_field(Archive& archive, ProfileResult& value) {
  auto& [summary, profile, infeasibility] = value;
  archive(summary, profile, infeasibility);
}

template <class Archive>
void each_field(Archive& archive, ReplayResult& value) {
  auto& [energy_J, motion_energy_J, duration_s, end_s, worst_violation, limit, s, x_m, y_m] = value;
  archive(energy_J, motion_energy_J, duration_s, end_s, worst_violation, limit, s, x_m, y_m);
}

template <class Archive>
void each_field(Archive& archive, EnergyByCause& value) {
  auto& [copper_J, coulomb_friction_J, viscous_friction_J, kinetic_J, not_recovered_J, standby_J, effects_J] =
      value;
  archive(copper_J, coulomb_friction_J, viscous_friction_J, kinetic_J, not_recovered_J, standby_J, effects_J);
}

template <class Archive>
void each_field(Archive& archive, Limits& value) {
  auto& [speed, acceleration, deceleration, lateral, yaw_rate, yaw_acceleration, wheel_acceleration, jerk,
         traction, motor_power, battery_power, max_payload, reverse_speed, battery_voltage, charge_power] =
      value;
  archive(speed, acceleration, deceleration, lateral, yaw_rate, yaw_acceleration, wheel_acceleration, jerk,
          traction, motor_power, battery_power, max_payload, reverse_speed, battery_voltage, charge_power);
}

template <class Archive>
void each_field(Archive& archive, PayloadAlongPath& value) {
  auto& [from_kg, to_kg] = value;
  archive(from_kg, to_kg);
}

template <class Archive>
void each_field(Archive& archive, SpeedCap& value) {
  auto& [from_m, to_m, speed_m_s] = value;
  archive(from_m, to_m, speed_m_s);
}

template <class Archive>
void each_field(Archive& archive, TimeGoal& value) {
  auto& [mode, duration_s, price_W] = value;
  archive(mode, duration_s, price_W);
}

/// Used for questions only. Of the plant only what drifts over a mission is in it (LegState): SharedAnswers::
/// world identifies its robot.
inline void each_field(ByteWriter& archive, ProfileRequest& value) {
  auto& [piece, plant, limits, payload, start_rate, end_rate, speed_caps, time, nodes, accuracy, proven,
         solver, draft, time_of_day_s, memory] = value;
  archive(record_of(piece), limits, payload, start_rate, end_rate, speed_caps, time, nodes, accuracy, proven,
          solver, draft, time_of_day_s, memory, drifting_constants(plant));
}

}  // namespace joulepath
