#pragma once

#include <algorithm>

#include "benchmarks/path_bound/motions.hpp"
#include "model/robot.hpp"

namespace joulepath::path_bound {

/// The constants of a robot file with equal motors and wheels, for the judge. Effects are left out.
inline JudgeRobot judge_robot(const Robot& robot, const Limits& limits, double payload_kg) {
  const Motor& motor = robot.motor.left;
  return {.wheel_radius_m = robot.geometry.wheel_radius_m.left,
          .half_track_m = robot.geometry.half_track_m,
          .center_of_mass_m = robot.geometry.center_of_mass_offset_m,
          .chassis_kg = robot.inertia.chassis_mass_kg,
          .wheel_kg = robot.inertia.wheel_mass_kg,
          .chassis_yaw_kg_m2 = robot.inertia.chassis_yaw_inertia_kg_m2,
          .wheel_spin_kg_m2 = robot.inertia.wheel_axle_inertia_kg_m2,
          .wheel_yaw_kg_m2 = robot.inertia.wheel_diameter_inertia_kg_m2,
          .payload_kg = payload_kg,
          .payload_yaw_m2 = robot.inertia.payload_yaw_inertia_m2,
          .gear = motor.gear_ratio,
          .resistance_ohm = motor.resistance_ohm,
          .torque_constant = motor.torque_constant_Nm_A,
          .voltage_constant = motor.voltage_constant_V_s_rad,
          .viscous = motor.viscous_friction_Nm_s_rad,
          .friction_left = robot.motor.left.friction_torque_Nm,
          .friction_right = robot.motor.right.friction_torque_Nm,
          .standby_W = robot.power.standby_W,
          .regeneration = robot.power.regeneration_efficiency,
          .bus = robot.power.sharing == PowerSharing::bus,
          .speed = limits.speed_m_s,
          .acceleration = limits.acceleration_m_s2,
          .deceleration = limits.deceleration_m_s2,
          .lateral = limits.lateral_acceleration_m_s2,
          .yaw_rate = limits.yaw_rate_rad_s,
          .yaw_acceleration = limits.yaw_acceleration_rad_s2};
}

/// A robot with what makes a bound difficult: recovered energy, unequal friction, a center of mass off the
/// axle, limits far from each other. All may drive backward but one.
struct Variant {
  const char* name{};
  double payload_kg{};
  double regeneration{};
  double center_of_mass_m{};
  double friction_left_Nm{0.3728};
  bool bus{};
  bool forward_only{};
  double acceleration_m_s2{0.5}, deceleration_m_s2{0.5};
  double yaw_rate_rad_s{2}, yaw_acceleration_rad_s2{2};
};
inline constexpr Variant kVariants[] = {{.name = "plain"},
                                        {.name = "forward only", .forward_only = true},
                                        {.name = "loaded", .payload_kg = 8},
                                        {.name = "recovers all", .regeneration = 1},
                                        {.name = "nose-heavy", .payload_kg = 5, .center_of_mass_m = 0.08},
                                        {.name = "tail-heavy on a bus",
                                         .regeneration = 0.5,
                                         .center_of_mass_m = -0.06,
                                         .friction_left_Nm = 0.6,
                                         .bus = true},
                                        {.name = "brakes hard, turns slowly",
                                         .acceleration_m_s2 = 0.3,
                                         .deceleration_m_s2 = 1.2,
                                         .yaw_rate_rad_s = 0.4,
                                         .yaw_acceleration_rad_s2 = 0.5},
                                        {.name = "turns quickly",
                                         .regeneration = 0.5,
                                         .center_of_mass_m = 0.03,
                                         .yaw_rate_rad_s = 5,
                                         .yaw_acceleration_rad_s2 = 8}};

inline Robot robot_of(Robot robot, const Variant& variant) {
  robot.geometry.center_of_mass_offset_m = variant.center_of_mass_m;
  robot.motor.left.friction_torque_Nm = variant.friction_left_Nm;
  robot.power.regeneration_efficiency = variant.regeneration;
  robot.power.sharing = variant.bus ? PowerSharing::bus : PowerSharing::wheel;
  robot.limits->acceleration_m_s2 = variant.acceleration_m_s2;
  robot.limits->deceleration_m_s2 = variant.deceleration_m_s2;
  robot.limits->yaw_rate_rad_s = variant.yaw_rate_rad_s;
  robot.limits->yaw_acceleration_rad_s2 = variant.yaw_acceleration_rad_s2;
  robot.limits->reverse_speed_m_s = variant.forward_only ? kNoLimit : robot.limits->speed_m_s;
  return robot;
}

inline bool drives_backward(const Motion& motion) {
  return std::any_of(motion.speed_m_s.begin(), motion.speed_m_s.end(), [](double v) { return v < 0; });
}

}  // namespace joulepath::path_bound
