#pragma once

#include <array>
#include <cstddef>

#include "machine.hpp"

namespace blind {

/// Everything that acts on the machine or on its sensors in addition to the constants of `Machine`; zero =
/// absent. Each effect of the catalog sets its own field; foreign effects come last and are not in the
/// catalog.
struct World {
  // Resistance.
  double rolling_coefficient{};
  double patch_coefficient{};
  std::array<double, 4> patch_m{};  ///< x min, x max, y min, y max
  double stribeck_torque_Nm{};
  double stribeck_speed_rad_s{1.0};
  Pair drag_torque_Nm{};  ///< dragging wheel
  double reverse_torque_Nm{};
  double gear_loss_fraction{};
  double scrub_moment_Nm{};
  double caster_moment_Nm{};
  double caster_trail_m{0.1};
  double air_drag_N_s2_m2{};
  // Floor.
  double slope_grade{};
  double uphill_direction_rad{};
  // Electrical.
  double heating_fraction{};
  double heating_time_s{100.0};
  double driver_drop_V{};
  // Instruments.
  Pair current_offset_A{};
  double current_gain{};
  double electrical_delay_s{};
  // Rough level: slight departures from the textbook forms, in every case of that level.
  double form{};             ///< relative change of an effect's size over its own driving variable
  Pair cogging_torque_Nm{};  ///< ripple over the wheel angle
  Pair cogging_phase_rad{};
  double cogging_per_rev{};
  double rolling_speed_slope_s_m{};  ///< bearing friction grows slightly with speed

  // Foreign effects.
  Pair eccentric_torque_Nm{};   ///< an out-of-round wheel: torque once per revolution
  double belt_set_torque_Nm{};  ///< a belt that took a set while standing: decays with the angle travelled
  double belt_set_angle_rad{2.0};
  double draft_force_N{};  ///< air stream in one map direction, growing over the day
  double draft_direction_rad{};
  Pair flat_spot_torque_Nm{};  ///< a flat spot: a narrow bump once per revolution
  double cable_N_m{};          ///< a trailing cable: pull toward the dock, proportional to the distance
  double slosh_fraction{};     ///< part of the payload that swings on a spring
  double slosh_frequency_rad_s{6.0};
  double grease_torque_Nm{};  ///< cold grease: friction that decays over the day
  double grease_time_s{100.0};
  Pair encoder_drift{};     ///< wheel-speed reading grows with the time of day (relative, at 400 s)
  double eddy_torque_Nm{};  ///< a magnetic brake: torque peaks at the critical speed, falls above
  double eddy_speed_rad_s{3.0};
  double foldback_current_A{};  ///< driver that reduces its output above this current (0 = never)

  bool operator==(const World&) const = default;
};

}  // namespace blind
