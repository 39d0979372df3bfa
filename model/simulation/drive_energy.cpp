#include <cmath>

#include "model/simulation/drive_forces.hpp"

namespace joulepath {

void Drive::integrals(const DriveState& state, const Forces& forces, double hot, Instant& instant) const {
  const Robot& robot = plant_.robot;
  DriveState& rate = instant.derivative;
  Sided<double> power_W{};
  for (Side side : kSides) {
    const std::size_t k = static_cast<std::size_t>(side == Side::right);
    const Motor& motor = robot.motor[side];
    const double i = instant.current_A[side];
    const double speed_rad_s = state[kVelocity + surface_of(side)];
    power_W[side] = instant.voltage_V[side] * i;
    rate[kVoltSeconds + k] = instant.voltage_V[side];
    rate[kCharge + k] = i;
    rate[kEnergy + k] = power_W[side];
    rate[kCopperLoss] += hot * motor.resistance_ohm * i * i +
                         (motor.volts_per_speed_V_s_rad() - motor.torque_per_ampere_Nm_A()) * i * speed_rad_s;
    rate[kDriverLoss] += plant_.driver_voltage_drop_V * std::abs(i);
    rate[kGearLoss] += forces.gear_loss_Nm[side] * speed_rad_s;
    rate[kWheelFriction] += forces.friction_Nm[side] * speed_rad_s;
    if (creeps_) rate[kCreepLoss] += forces.creep_m_s[side] * instant.contact_force_N[side];
  }
  rate[kBodyWork] =
      forces.load.force_N * state[kVelocity + kTravel] + forces.load.moment_Nm * state[kVelocity + kTurn];
  const double terminals_W = supply_power_W(robot.power, power_W) + robot.power.standby_W;
  const BatteryLoad battery = battery_load(robot.battery, terminals_W);
  instant.battery_gives_way = !battery.possible;
  instant.battery_voltage_V = battery.terminal_voltage_V;
  rate[kBatteryVoltSeconds] = std::isfinite(instant.battery_voltage_V) ? instant.battery_voltage_V : 0.0;
  rate[kBatteryCharge] = battery.current_A;
  rate[kBatteryEnergy] = terminals_W;
  rate[kBatteryLoss] = battery.loss_W;
}

double Drive::stored_energy_J(const DriveState& state) const {
  const Robot& robot = plant_.robot;
  double energy_J = kinetic_energy_J(robot, mass_, state[kVelocity + kTravel], state[kVelocity + kTurn],
                                     {state[kVelocity + kLeftWheel], state[kVelocity + kRightWheel]});
  for (Side side : kSides) {
    const double i = state[kArmatureLeft + static_cast<std::size_t>(side == Side::right)];
    energy_J += 0.5 * robot.motor[side].inductance_H * i * i;
  }
  return energy_J;
}

}  // namespace joulepath
