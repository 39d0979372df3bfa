#pragma once

#include <array>
#include <string>
#include <vector>

namespace control {

using Pair = std::array<double, 2>;  ///< {left, right}
using Column = std::vector<double>;

/// The numbers of a robot file that the controls use.
struct Robot {
  double radius_m{}, half_track_m{}, center_offset_m{};
  double chassis_kg{}, wheel_kg{}, yaw_inertia{}, payload_yaw_inertia_m2{}, axle_inertia{},
      diameter_inertia{};
  double gear{}, ohm{}, torque_constant{}, viscous{};
  Pair friction_Nm{};
  double standby_W{}, regeneration{}, open_circuit_V{}, internal_ohm{};
  double torque_per_ampere() const { return gear * torque_constant; }
};

/// One run's channels, with the smoothed motion for the regressors of all controls.
struct Run {
  double payload_kg{}, start_s{};
  Column time_s;
  std::array<Column, 2> speed, volts, amps;  ///< as logged
  Column battery_V, battery_A, gyro, x_m, y_m, heading;
  std::array<Column, 2> smooth_speed, acceleration, smooth_amps;
};

struct DataSet {
  Robot robot;
  std::vector<Run> runs;
};

/// Read a folder that blind_plant wrote (its own narrow form of YAML and CSV). Throws std::runtime_error.
[[nodiscard]] DataSet read_data_set(const std::string& folder);

}  // namespace control
