#pragma once

#include <array>
#include <random>
#include <string>
#include <vector>

// Random motions that a robot can drive, and their energy, for judging lower bounds. Nothing here uses the
// product: the robot's constants and the equations of motion are written out again.
namespace joulepath::path_bound {

/// Constants of a robot with two equal drives except for their dry friction.
struct JudgeRobot {
  double wheel_radius_m{}, half_track_m{}, center_of_mass_m{};
  double chassis_kg{}, wheel_kg{}, chassis_yaw_kg_m2{}, wheel_spin_kg_m2{}, wheel_yaw_kg_m2{};
  double payload_kg{}, payload_yaw_m2{};
  double gear{}, resistance_ohm{}, torque_constant{}, voltage_constant{}, viscous{}, friction_left{},
      friction_right{};
  double standby_W{}, regeneration{};
  bool bus{};
  double speed{}, acceleration{}, deceleration{}, lateral{}, yaw_rate{}, yaw_acceleration{};
};

/// Speed (negative in reverse) and yaw rate, both linear between the times; at rest at both ends.
struct Motion {
  std::string kind{};
  std::vector<double> time_s{}, speed_m_s{}, yaw_rate_rad_s{};
};

struct Driven {
  double energy_J{};
  double way_m{};                      ///< length of the way, in reverse counted as well
  double x_m{}, y_m{}, heading_rad{};  ///< at the end, from (0, 0, 0)
  double duration_s{};
  bool within_limits{};
};

/// Integrates a motion: Gauss-Legendre of order 6 in time on short steps.
[[nodiscard]] Driven drive(const JudgeRobot& robot, const Motion& motion);

/// A random motion whose way is about `way_m` long: straight and nearly optimal, with small waves, with hooks
/// at its ends, spinning up while it accelerates and down while it brakes, creeping, with cusps, or with
/// turns in place. Every third one is a small change of the cheapest straight motion.
[[nodiscard]] Motion random_motion(const JudgeRobot& robot, double way_m, std::mt19937& random);

/// Motions made to break a bound: the cheapest straight lines, and the ways in which one prices energy
/// wrongly, which random motions hardly meet.
[[nodiscard]] std::vector<Motion> worst_motions(const JudgeRobot& robot, double way_m);

}  // namespace joulepath::path_bound
