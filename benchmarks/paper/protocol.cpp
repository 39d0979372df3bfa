#include "benchmarks/paper/protocol.hpp"

#include <algorithm>
#include <cmath>
// Design: docs/decisions/0803-judges.md
namespace joulepath::bench {
namespace {

/// Time to cover a distance from a speed at a constant acceleration that does not stop before it.
double time_to_cover_s(double speed_m_s, double acceleration_m_s2, double distance_m) {
  const double end_m_s = std::sqrt(std::max(0.0, speed_m_s * speed_m_s + 2 * acceleration_m_s2 * distance_m));
  return 2 * distance_m / (speed_m_s + end_m_s);
}

/// Appends a phase, shortened to `left_m`; returns the remaining distance.
double append(SpeedProfile& profile, Phase phase, double left_m) {
  if (left_m <= 0) return 0;
  if (phase.distance_m() > left_m)
    phase.duration_s = time_to_cover_s(phase.start_speed_m_s, phase.acceleration_m_s2, left_m);
  profile.push_back(phase);
  return left_m - phase.distance_m();
}

constexpr double kRounding_m = 1e-9;

}  // namespace

SpeedProfile ramp_then_cruise(double entry_speed_m_s, double acceleration_m_s2, double ramp_s,
                              double distance_m) {
  SpeedProfile profile;
  const double left_m = append(profile, {entry_speed_m_s, acceleration_m_s2, ramp_s}, distance_m);
  const double speed_m_s = entry_speed_m_s + acceleration_m_s2 * ramp_s;
  if (left_m > kRounding_m) profile.push_back({speed_m_s, 0.0, left_m / speed_m_s});
  return profile;
}

SpeedProfile repeated_ramps(double acceleration_m_s2, double ramp_s, double deceleration_m_s2,
                            double distance_m) {
  SpeedProfile profile;
  const double top_m_s = acceleration_m_s2 * ramp_s;
  double left_m = distance_m;
  while (left_m > kRounding_m) {
    left_m = append(profile, {0.0, acceleration_m_s2, ramp_s}, left_m);
    left_m = append(profile, {top_m_s, -deceleration_m_s2, top_m_s / deceleration_m_s2}, left_m);
  }
  return profile;
}

SpeedProfile accelerate_throughout(double entry_speed_m_s, double acceleration_m_s2, double distance_m) {
  return {
      {entry_speed_m_s, acceleration_m_s2, time_to_cover_s(entry_speed_m_s, acceleration_m_s2, distance_m)}};
}

SpeedProfile up_and_down(double entry_speed_m_s, double acceleration_m_s2, double distance_m) {
  SpeedProfile profile = accelerate_throughout(entry_speed_m_s, acceleration_m_s2, distance_m / 2);
  const double top_m_s = entry_speed_m_s + acceleration_m_s2 * profile[0].duration_s;
  profile.push_back({top_m_s, -acceleration_m_s2, profile[0].duration_s});
  return profile;
}

}  // namespace joulepath::bench
