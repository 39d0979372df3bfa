#pragma once

#include <cmath>
#include <functional>
#include <random>

#include "diagnosis/values/dataset.hpp"
#include "model/operating_point.hpp"

namespace joulepath::testing {

/// Body speed and yaw rate with their derivatives at a time.
using MotionLaw = std::function<BodyMotion<double>(double time_s)>;

/// White noise of the channels of a synthetic log; zero = exact.
struct LogNoise {
  double speed_rad_s{};
  double current_A{};
  double voltage_V{};
};

/// The log of an ideal robot for a motion: wheel speeds, voltages, currents by the model of the product.
inline Run synthetic_run(const Robot& robot, const std::string& name, double duration_s, double payload_kg,
                         const MotionLaw& law, const LogNoise& noise = {}, unsigned seed = 1,
                         double period_s = 0.02) {
  const Plant plant = make_plant(robot, {});
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Run run{.name = name, .payload = {{0, payload_kg}}, .payload_known = true};
  for (int k = 0; k * period_s <= duration_s; ++k) {
    const double t = k * period_s;
    const BodyMotion<double> motion = law(t);
    const Site site = site_of(robot.geometry, {}, payload_kg, motion.speed_m_s, motion.yaw_rate_rad_s);
    const auto wheels = operating_point(plant, motion, site);
    run.log.time_s.push_back(t);
    run.log.payload_kg.push_back(payload_kg);
    for (Side side : kSides) {
      run.log.wheel_speed_rad_s[side].push_back(wheels[side].speed_rad_s +
                                                noise.speed_rad_s * normal(random));
      run.log.motor_current_A[side].push_back(wheels[side].current_A + noise.current_A * normal(random));
      run.log.motor_voltage_V[side].push_back(wheels[side].voltage_V + noise.voltage_V * normal(random));
    }
  }
  return run;
}

/// A speed and yaw rate that swing about their means: smooth, never at rest.
inline MotionLaw swinging(double mean_m_s, double swing_m_s, double rate_rad_s, double yaw_swing_rad_s = 0,
                          double yaw_rate_rad_s = 0.7) {
  return [=](double t) {
    return BodyMotion<double>{
        .speed_m_s = mean_m_s + swing_m_s * std::sin(rate_rad_s * t),
        .acceleration_m_s2 = swing_m_s * rate_rad_s * std::cos(rate_rad_s * t),
        .yaw_rate_rad_s = yaw_swing_rad_s * std::sin(yaw_rate_rad_s * t),
        .yaw_acceleration_rad_s2 = yaw_swing_rad_s * yaw_rate_rad_s * std::cos(yaw_rate_rad_s * t)};
  };
}

inline MotionLaw constant_speed(double speed_m_s) {
  return [=](double) { return BodyMotion<double>{.speed_m_s = speed_m_s}; };
}

}  // namespace joulepath::testing
