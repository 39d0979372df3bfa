#pragma once

#include <string>
#include <vector>

#include "machine.hpp"
#include "random.hpp"

namespace blind {

inline constexpr double kControlPeriod_s = 0.01;
inline constexpr double kSamplePeriod_s = 0.02;

/// What the robot is told to do in one run: body speed and yaw rate at every control tick.
struct Run {
  std::string kind{};
  double payload_kg{};    ///< as weighed
  double start_time_s{};  ///< time of day
  double heading_rad{};   ///< at the start; the start itself is the map's origin
  std::vector<double> speed_m_s{};
  std::vector<double> yaw_rate_rad_s{};
  double duration_s() const { return static_cast<double>(speed_m_s.size()) * kControlPeriod_s; }
};

/// A test day of 24, 12 or 6 runs: straight at several speeds and accelerations, both spins, arcs, Bezier
/// curves, reverse, slow and fast, several headings, payloads mixed, in random order.
[[nodiscard]] std::vector<Run> test_day(const Machine& nominal, int run_count, Random& random);

/// One motion from its description, as `next_experiment` proposes it: kind is trapezoid, constant_ramp,
/// constant_speed, spin, arc, stand or coast.
struct Motion {
  std::string kind{"trapezoid"};
  double speed_m_s{0.5};
  double acceleration_m_s2{0.2};
  double cruise_s{6.0};
  double yaw_rate_rad_s{0.8};
  double curvature_per_m{0.8};
  bool reverse{false};
  double payload_kg{0.0};
  double heading_rad{0.0};
};
[[nodiscard]] Run run_of(const Motion& motion);

}  // namespace blind
