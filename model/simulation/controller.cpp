#include "model/simulation/controller.hpp"

#include <algorithm>
#include <cmath>
// Design: docs/decisions/0102-simulation.md
namespace joulepath {
namespace {

constexpr double kStandingSpeed_rad_s = 0.05;
constexpr double kDrain_s = 0.1;

}  // namespace

WheelController::WheelController(const ControllerSettings& settings, const Robot& robot)
    : settings_(settings), nominal_(make_plant(robot)) {
  const double mass_kg = robot.total_mass_kg(0.0);
  for (Side side : kSides) {
    const Motor& motor = robot.motor[side];
    const double r = robot.geometry.wheel_radius_m[side];
    const double inertia = mass_kg * r * r / 2 + robot.inertia.wheel_axle_inertia_kg_m2;
    const double volts_per_torque = motor.resistance_ohm / motor.torque_per_ampere_Nm_A();
    const double rate = settings.bandwidth_per_s;
    proportional_[side] = settings.proportional_V_s_rad.value_or(volts_per_torque * inertia * rate);
    integral_[side] = settings.integral_V_rad.value_or(proportional_[side] * rate / 3);
  }
}

Sided<double> WheelController::command_V(const BodyMotion<double>& reference, const Site& site,
                                         const Sided<double>& wheel_speed_rad_s,
                                         const Sided<double>& limit_V) {
  const Sided<double> wanted =
      wheel_speeds_rad_s(nominal_.robot.geometry, reference.speed_m_s, reference.yaw_rate_rad_s);
  Sided<double> feed_forward_V{};
  if (settings_.feed_forward) {
    const auto wheels = operating_point(nominal_, reference, site);
    feed_forward_V = {wheels.left.voltage_V, wheels.right.voltage_V};
  }
  const bool to_stand = wanted.left == 0.0 && wanted.right == 0.0 && reference.acceleration_m_s2 == 0.0 &&
                        reference.yaw_acceleration_rad_s2 == 0.0;
  Sided<double> command_V{};
  for (Side side : kSides) {
    const double error = wanted[side] - wheel_speed_rad_s[side];
    if (to_stand) {  // a smooth function of speed, so that a run does not depend on the exact instant of a
                     // stop
      const double ratio = wheel_speed_rad_s[side] / kStandingSpeed_rad_s;
      integral_V_[side] *= std::exp(-settings_.period_s / (kDrain_s * (1 + ratio * ratio)));
    }
    const double tried_V = integral_V_[side] + integral_[side] * error * settings_.period_s;
    const double sum_V = (to_stand ? 0.0 : feed_forward_V[side]) + proportional_[side] * error + tried_V;
    command_V[side] = std::clamp(sum_V, -limit_V[side], limit_V[side]);
    if (command_V[side] == sum_V || std::abs(tried_V) < std::abs(integral_V_[side]))
      integral_V_[side] = tried_V;
  }
  return command_V;
}

}  // namespace joulepath
