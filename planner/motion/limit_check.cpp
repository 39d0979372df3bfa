#include "planner/motion/limit_check.hpp"

#include <algorithm>
#include <cmath>

#include "model/operating_point.hpp"
#include "model/power.hpp"
#include "planner/motion/path_motion.hpp"

namespace joulepath {
namespace {

/// Below these magnitudes a value counts as zero where the limit itself is zero.
constexpr double kNothing = 1e-12;
/// A cap holds inside of its interval: where it ends, the neighbour may already be faster.
constexpr double kBorder_m = 1e-9;

double ratio_of(double value, double limit) {
  const double size = std::abs(value);
  if (limit <= 0) return size <= kNothing ? 0.0 : kNoLimit;
  return size / limit;
}

}  // namespace

void for_each_limit_use(const PathMotion& motion, const Limits& limits, const std::vector<SpeedCap>& caps,
                        const ProfileState& state, double jerk,
                        const std::function<void(std::string_view, double)>& use) {
  const auto check = [&](std::string_view name, double value, double limit) {
    if (std::isfinite(limit)) use(name, ratio_of(value, limit));
  };
  const PathMotion::Place place = motion.place(state.s, state.time_s);
  const BodyMotion<double> body = PathMotion::body_motion(place.rates, state.rate, state.acceleration);
  check("speed", body.speed_m_s, limits.speed_m_s);
  if (place.rates.along != 0) {
    for (const SpeedCap& cap : caps)
      if (state.s > cap.from_m + kBorder_m && state.s < cap.to_m - kBorder_m)
        check("speed", body.speed_m_s, cap.speed_m_s);
    const bool braking = state.acceleration < 0;
    check(braking ? "deceleration" : "acceleration", state.acceleration,
          braking ? limits.deceleration_m_s2 : limits.acceleration_m_s2);
    check("jerk", jerk, limits.jerk_m_s3);
  }
  check("lateral_acceleration", body.speed_m_s * body.yaw_rate_rad_s, limits.lateral_acceleration_m_s2);
  check("yaw_rate", body.yaw_rate_rad_s, limits.yaw_rate_rad_s);
  check("yaw_acceleration", body.yaw_acceleration_rad_s2, limits.yaw_acceleration_rad_s2);

  const Plant& plant = motion.plant();
  const Robot& robot = plant.robot;
  const Sided<WheelState<double>> wheels = operating_point(plant, body, place.site);
  const Sided<double> acceleration =
      wheel_speeds_rad_s(robot.geometry, body.acceleration_m_s2, body.yaw_acceleration_rad_s2);
  const double load_N = 0.5 * robot.total_mass_kg(plant.payload_kg(place.site.payload_kg)) * kGravity_m_s2;
  for (Side side : kSides) {
    check("wheel_acceleration", acceleration[side], limits.wheel_acceleration_rad_s2);
    check("traction", wheels[side].contact_force_N, limits.traction_coefficient * load_N);
    check("motor_current", wheels[side].current_A, robot.motor[side].max_current_A);
    check("motor_voltage", wheels[side].voltage_V, robot.motor[side].max_voltage_V);
    check("motor_power", wheels[side].power_W, limits.motor_power_W);
  }
  const double supply_W =
      supply_power_W(robot.power, {wheels.left.power_W, wheels.right.power_W}) + robot.power.standby_W;
  check("battery_power", std::max(0.0, supply_W), limits.battery_power_W);
}

bool acceleration_jumps(const Profile& profile, double& s) {
  constexpr double kJump = 1e-5;  // m/s^2: rounding of sums is far below
  double before = 0;
  for (std::size_t k = 0; k < profile.acceleration.size(); ++k) {
    s = profile.s[k];
    if (std::abs(profile.acceleration[k] - before) > kJump) return true;
    before = profile.acceleration[k] + profile.jerk[k] * (profile.time_s[k + 1] - profile.time_s[k]);
  }
  s = profile.s.back();
  return std::abs(before) > kJump;
}

}  // namespace joulepath
