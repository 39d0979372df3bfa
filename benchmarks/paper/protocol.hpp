#pragma once

#include <vector>

namespace joulepath::bench {

/// A stretch of constant acceleration.
struct Phase {
  double start_speed_m_s{};
  double acceleration_m_s2{};
  double duration_s{};

  double distance_m() const {
    return start_speed_m_s * duration_s + 0.5 * acceleration_m_s2 * duration_s * duration_s;
  }
};

/// Speed over time along a path.
using SpeedProfile = std::vector<Phase>;

// Possible protocols of the drives; the paper does not state all of them. Each profile ends when `distance_m`
// is covered, also within a phase.

/// Accelerate for `ramp_s` from `entry_speed_m_s`, then hold the speed.
[[nodiscard]] SpeedProfile ramp_then_cruise(double entry_speed_m_s, double acceleration_m_s2, double ramp_s,
                                            double distance_m);

/// Accelerate for `ramp_s` from rest, brake to rest, again and again.
[[nodiscard]] SpeedProfile repeated_ramps(double acceleration_m_s2, double ramp_s, double deceleration_m_s2,
                                          double distance_m);

/// Accelerate all the way from `entry_speed_m_s`.
[[nodiscard]] SpeedProfile accelerate_throughout(double entry_speed_m_s, double acceleration_m_s2,
                                                 double distance_m);

/// Accelerate over the first half of the way, brake at the same rate over the second.
[[nodiscard]] SpeedProfile up_and_down(double entry_speed_m_s, double acceleration_m_s2, double distance_m);

}  // namespace joulepath::bench
