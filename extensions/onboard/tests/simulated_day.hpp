#pragma once

#include <cmath>
#include <vector>

#include "extensions/onboard/monitor/monitor.hpp"
#include "model/simulation/simulate.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath::testing {

/// A day of a robot: out, a turn in place, back, with stops; over and over.
struct Day {
  TimedMotion motion{};
  double payload_kg{4.0};  ///< as stated
};

inline Day day(int rounds, unsigned seed = 1) {
  std::vector<PrescribedMotion> motions;
  for (int i = 0; i < rounds; ++i) {
    const double varied = 0.5 + 0.5 * std::sin(1.7 * i + seed);
    motions.push_back({.profile = MotionProfile::trapezoid,
                       .acceleration_m_s2 = 0.3 + 0.2 * varied,
                       .speed_m_s = 0.5 + 0.4 * varied,
                       .distance_m = 4.0 + 3 * varied});
    motions.push_back({.profile = MotionProfile::stand, .duration_s = 1.5});
    motions.push_back({.profile = MotionProfile::spin,
                       .angle_rad = 3.14159265,
                       .yaw_rate_rad_s = 1.2,
                       .yaw_acceleration_rad_s2 = 1.5});
    motions.push_back({.profile = MotionProfile::stand, .duration_s = 1.0});
  }
  Day result;
  result.motion = timed_motion(nomad(), motions, {.payload_kg = result.payload_kg});
  return result;
}

/// What a day does that its statement does not say.
struct Hidden {
  double from_share{1.0};  ///< of the day: when the payload changes
  double extra_kg{};
  std::vector<EffectSetting> effects{};
};

inline SimulationResult drive(const Day& day, const Hidden& hidden, std::uint64_t seed = 1) {
  SimulationRequest request{.robot = nomad(),
                            .effects = hidden.effects,
                            .reference = day.motion.trajectory,
                            .payload_kg = day.payload_kg,
                            .sensors = typical_sensors(),
                            .seed = seed};
  std::vector<double>& payload_kg = request.reference.payload_kg;
  const std::vector<double>& time_s = request.reference.time_s;
  payload_kg.assign(time_s.size(), day.payload_kg);
  for (std::size_t k = 0; k < time_s.size(); ++k)
    if (time_s[k] >= hidden.from_share * time_s.back()) payload_kg[k] += hidden.extra_kg;
  return simulate(request);
}

inline MonitorRow row_of(const Trajectory& log, std::size_t k, double stated_kg) {
  return {.time_s = log.time_s[k],
          .wheel_speed_rad_s = {log.wheel_speed_rad_s.left[k], log.wheel_speed_rad_s.right[k]},
          .motor_voltage_V = {log.motor_voltage_V.left[k], log.motor_voltage_V.right[k]},
          .motor_current_A = {log.motor_current_A.left[k], log.motor_current_A.right[k]},
          .payload_kg = stated_kg};
}

}  // namespace joulepath::testing
