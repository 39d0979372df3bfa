#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "machine.hpp"
#include "random.hpp"

namespace blind {

inline constexpr double kControlPeriod_s = 0.01;
inline constexpr double kSamplePeriod_s = 0.02;

/// A payload from a control tick on, as weighed.
struct Loading {
  std::size_t tick{};
  double payload_kg{};
};

/// The command of one run: body speed and yaw rate at every control tick.
struct Run {
  std::string kind{};
  double payload_kg{};                ///< at the start, as weighed
  std::vector<Loading> reloadings{};  ///< at standstills, later
  double start_time_s{};              ///< time of day
  double heading_rad{};               ///< at the start; the start itself is the map's origin
  std::vector<double> speed_m_s{};
  std::vector<double> yaw_rate_rad_s{};
  double duration_s() const { return static_cast<double>(speed_m_s.size()) * kControlPeriod_s; }
};

/// A test day of 24, 12 or 6 runs: straight at several speeds and accelerations, both spins, arcs, Bezier
/// curves, reverse, slow and fast, several headings, payloads mixed, in random order.
[[nodiscard]] std::vector<Run> test_day(const Machine& nominal, int run_count, Random& random);

/// The day as one long run: its motions one after the other with a rest between, the payload of the first.
[[nodiscard]] Run one_long_run(const std::vector<Run>& day);

/// One more run from a description such as a diagnosis proposes: legs from rest to rest joined by `+`, each
/// `profile:trapezoid,speed_m_s:0.5,...` with the keys of a prescribed motion (profile, speed_m_s,
/// acceleration_m_s2, distance_m, duration_s, ramp_s, radius_m, angle_rad, yaw_rate_rad_s,
/// yaw_acceleration_rad_s2, direction, payload_kg); the first leg's heading_rad is the run's. A payload that
/// a leg leaves out is the one before. Throws std::invalid_argument.
[[nodiscard]] Run described_run(const std::string& description, const Machine& nominal);

}  // namespace blind
