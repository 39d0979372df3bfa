#include "scenarios/robot_files/implausible_constants.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/abilities.hpp"
#include "model/printable.hpp"
#include "scenarios/robot_files/robot_check.hpp"

namespace joulepath {
namespace {

// Bounds that wheeled robots of 2 to 2000 kg keep with a factor of two or more; a slip of a unit is a factor
// of 57 (degrees) or more.
constexpr double kLeastGyration = 0.1;              ///< radius of gyration over the reach
constexpr double kReachInHalfTracks = 3.0;          ///< of a robot without a footprint
constexpr double kFastestYaw_rad_s = 10.0;          ///< nearly two turns a second
constexpr double kGreatestTurnRatio = 6.0;          ///< of the wheels' motion in a turn over that of the body
constexpr double kMostEnergy_Wh_kg = 200.0;         ///< of the whole robot: lithium cells alone have 300
constexpr double kMostStandby_W_kg = 20.0;          ///< of the whole robot
constexpr double kMostTopSpeed = 5.0;               ///< by voltage, over the speed limit
constexpr double kLeastTopSpeed = 0.5;              ///< the same
constexpr double kMostStallCurrent = 30.0;          ///< max_voltage_V/resistance_ohm over max_current_A
constexpr double kAlwaysPossibleStandby_W = 200.0;  ///< a computer with a graphics card on a small robot
constexpr double kHeavy_kg = 1000.0;        ///< vehicles that charge at every stop may have small batteries
constexpr double kLeastEnergy_Wh_kg = 1.0;  ///< of the whole robot; supercapacitors have less
constexpr double kMostMotorVoltage = 1.5;   ///< over the battery's voltage
constexpr double kLeastRolling = 0.002;     ///< friction over weight: steel wheels on rails
constexpr double kGreatestReach = 10.0;     ///< of the outline, in half tracks
constexpr double kMostMass_kg_m2 = 5000.0;  ///< of the chassis over the disk within its outline
constexpr double kMostTorqueConstant_Nm_A = 2.0;  ///< of a motor with a gear

/// Greatest distance of the outline from the axle's middle along the heading.
double length_m(const Robot& robot) {
  double length_m = robot.footprint.radius_m;
  for (const auto& [x_m, y_m] : robot.footprint.polygon_m) length_m = std::max(length_m, std::abs(x_m));
  return length_m > 0.0 ? length_m : kReachInHalfTracks * robot.geometry.half_track_m;
}

/// Greatest distance of the outline from the chassis' center of mass.
double reach_m(const Robot& robot) {
  const double offset_m = robot.geometry.center_of_mass_offset_m;
  double reach_m = 0.0;
  for (const auto& [x_m, y_m] : robot.footprint.polygon_m)
    reach_m = std::max(reach_m, std::hypot(x_m - offset_m, y_m));
  if (robot.footprint.radius_m > 0.0) reach_m = robot.footprint.radius_m + std::abs(offset_m);
  return reach_m > 0.0 ? reach_m : kReachInHalfTracks * robot.geometry.half_track_m;
}

class Notes {
 public:
  void add(std::string note) { notes_.push_back(std::move(note)); }
  bool over(const std::string& key, double value, double most, const std::string& why, const char* slip) {
    const bool is = std::isfinite(value) && value > most;
    if (is) note(key, value, "at most ", most, why, slip);
    return is;
  }
  void under(const std::string& key, double value, double least, const std::string& why, const char* slip) {
    if (std::isfinite(least) && value > 0.0 && value < least) note(key, value, "at least ", least, why, slip);
  }
  std::vector<std::string> take() { return std::move(notes_); }

 private:
  void note(const std::string& key, double value, const char* side, double bound, const std::string& why,
            const char* slip) {
    notes_.push_back(key + " " + four_digits(value) + " is implausible: " + side + four_digits(bound) + " " +
                     why + "; " + slip);
  }

  std::vector<std::string> notes_{};
};

void note_yaw_limits(const Robot& robot, Notes& notes) {
  const Limits& limits = *robot.limits;
  const double turn_m = robot.geometry.half_track_m / kGreatestTurnRatio;
  notes.over("limits.yaw_rate_rad_s", limits.yaw_rate_rad_s,
             std::min(kFastestYaw_rad_s, limits.speed_m_s / turn_m), "rad/s for this track and speed_m_s",
             "is it in degrees per second?");
  notes.over("limits.yaw_acceleration_rad_s2", limits.yaw_acceleration_rad_s2,
             limits.acceleration_m_s2 / turn_m, "rad/s^2 for this track and acceleration_m_s2",
             "is it in degrees per second squared?");
}

/// Motors without voltage converters have the battery's voltage at most.
void note_battery(const Robot& robot, const std::string& on_robot, Notes& notes) {
  const Battery& battery = robot.battery;
  notes.over("battery.capacity_Wh", battery.capacity_Wh, kMostEnergy_Wh_kg * robot.total_mass_kg(0.0),
             "Wh" + on_robot, "is it in J, or in mAh?");
  if (robot.total_mass_kg(0.0) < kHeavy_kg)
    notes.under("battery.capacity_Wh", battery.capacity_Wh, kLeastEnergy_Wh_kg * robot.total_mass_kg(0.0),
                "Wh" + on_robot, "is it in Ah, or in kWh?");
  const double voltage_V = std::min(robot.motor.left.max_voltage_V, robot.motor.right.max_voltage_V);
  notes.over("motor.max_voltage_V", voltage_V, kMostMotorVoltage * battery.open_circuit_voltage_V,
             "V with battery.open_circuit_voltage_V " + four_digits(battery.open_circuit_voltage_V),
             "is one of them that of a single cell, or ten times too high?");
}

/// Friction that is smaller than the rolling resistance of any wheel under the robot's weight.
void note_friction(const Robot& robot, const std::string& on_robot, Notes& notes) {
  const bool resists_apart = std::ranges::any_of(robot.effects, [](const EffectSetting& effect) {
    return effect.name == "rolling_resistance" || effect.name == "coulomb_friction";
  });
  if (resists_apart) return;
  for (const Side side : kSides) {
    if (robot.motor[side].gear_ratio <= 1) continue;  // at the shaft it is the same
    if (side == Side::right && robot.motor.right.friction_torque_Nm == robot.motor.left.friction_torque_Nm)
      continue;
    const double weight_N = 0.5 * robot.total_mass_kg(0.0) * kGravity_m_s2;
    notes.under("motor.friction_torque_Nm, " + std::string(side_name(side)),
                robot.motor[side].friction_torque_Nm,
                kLeastRolling * weight_N * robot.geometry.wheel_radius_m[side],
                "N m for the rolling resistance" + on_robot,
                "is it at the motor's shaft? At the wheel it is gear_ratio times larger");
  }
}

/// Motors that cannot turn the wheels, or are much faster or slower than the speed limit.
void note_motors(const Robot& robot, Notes& notes) {
  const Abilities able = abilities_of(robot);
  for (const Side side : kSides) {
    if (able.can_move()) break;
    if (able.motor_torque_Nm[side] > able.friction_torque_Nm[side]) continue;
    notes.add("the robot cannot move: its " + std::string(side_name(side)) + " motor gives " +
              four_digits(able.motor_torque_Nm[side]) + " N m at the wheel, and " +
              four_digits(able.friction_torque_Nm[side]) +
              " N m of friction resist; is gear_ratio inverse, resistance_ohm in milliohm, or "
              "friction_torque_Nm in N cm?");
    return;
  }
  const Motor &left = robot.motor.left, &right = robot.motor.right;
  const Motor& motor = left.max_voltage_V <= right.max_voltage_V ? left : right;
  const double limit_m_s = robot.limits ? robot.limits->speed_m_s : kNoLimit;
  const std::string at_limit = "m/s of top speed by voltage for limits.speed_m_s";
  notes.over("motor.max_voltage_V: " + four_digits(motor.max_voltage_V) + " V with a top speed of",
             able.top_speed_m_s, kMostTopSpeed * limit_m_s, at_limit,
             "is the voltage ten times too high, or gear_ratio that of one stage?");
  if (std::isfinite(limit_m_s))
    notes.under(
        "motor.max_voltage_V: " + four_digits(motor.max_voltage_V) + " V with a top speed of",
        able.top_speed_m_s, kLeastTopSpeed * limit_m_s, at_limit,
        motor.gear_ratio > 1 && motor.torque_constant_Nm_A > kMostTorqueConstant_Nm_A
            ? "is motor.torque_constant_Nm_A in mN m/A?"
            : "is the limit in km/h, the voltage that of one cell, or gear_ratio that of another motor?");
  notes.under("motor.resistance_ohm", motor.resistance_ohm,
              motor.max_voltage_V / (kMostStallCurrent * motor.max_current_A),
              "ohm for max_voltage_V and max_current_A", "is it in kiloohm?");
}

}  // namespace

std::vector<std::string> implausible_constants(const Robot& robot) {
  Notes notes;
  note_motors(robot, notes);
  const double mass_kg = robot.total_mass_kg(0.0), far_m = reach_m(robot);
  // What follows depends on mass and center of mass.
  if (notes.over("geometry.center_of_mass_offset_m, without its sign,",
                 std::abs(robot.geometry.center_of_mass_offset_m), length_m(robot), "m for this outline",
                 "is it in cm?") ||
      notes.over("inertia.chassis_mass_kg", robot.inertia.chassis_mass_kg,
                 kMostMass_kg_m2 * std::numbers::pi * far_m * far_m, "kg within " + four_digits(far_m) + " m",
                 "is it in g?"))
    return notes.take();
  const double ring_kg_m2 = robot.inertia.chassis_mass_kg * far_m * far_m;  // all of the mass at the outline
  const std::string size =
      "kg m^2 for " + four_digits(robot.inertia.chassis_mass_kg) + " kg within " + four_digits(far_m) + " m";
  notes.over("inertia.chassis_yaw_inertia_kg_m2", robot.inertia.chassis_yaw_inertia_kg_m2, ring_kg_m2, size,
             "is it in kg cm^2?");
  notes.under("inertia.chassis_yaw_inertia_kg_m2", robot.inertia.chassis_yaw_inertia_kg_m2,
              kLeastGyration * kLeastGyration * ring_kg_m2, size,
              "is it that of a wheel, or of a part of the robot?");
  if (robot.limits) note_yaw_limits(robot, notes);
  const std::string on_robot = " on a robot of " + four_digits(mass_kg) + " kg";
  note_battery(robot, on_robot, notes);
  note_friction(robot, on_robot, notes);
  notes.over("footprint", has_footprint(robot) ? far_m : 0.0,
             kGreatestReach * robot.geometry.half_track_m + std::abs(robot.geometry.center_of_mass_offset_m),
             "m from the axle for half_track_m " + four_digits(robot.geometry.half_track_m), "is it in cm?");
  notes.over("power.standby_W", robot.power.standby_W,
             std::max(kAlwaysPossibleStandby_W, kMostStandby_W_kg * mass_kg), "W" + on_robot, "is it in mW?");
  return notes.take();
}

}  // namespace joulepath
