#pragma once

#include <vector>

#include "model/prescribed_motion.hpp"
#include "model/robot.hpp"
#include "model/trajectory.hpp"

namespace joulepath {

struct Interval {
  double from_s{};
  double to_s{};
};

/// A prescribed motion over time. Speeds are linear between the samples, and there is a sample wherever
/// an acceleration changes, so that interpolation is exact (nearly so on a Bezier curve).
struct TimedMotion {
  Trajectory trajectory{};           ///< speeds, wheel speeds, pose, arc length, curvature, payload
  std::vector<Interval> coasting{};  ///< when the motors carry no current
};

struct TimingOptions {
  Pose start{};
  double start_time_s{};
  double payload_kg{};
  std::vector<double> payload_of_motion_kg{};  ///< of each motion; empty: payload_kg of all
  double sample_period_s{0.02};
};

/// Prescribed motions over time, one after the other. Values that a prescription leaves out come from the
/// robot's limits; a coasting robot slows down according to its model with its effects.
///
/// Throws ConfigError (without a mark) if a needed value is in neither, or if the prescription contradicts
/// itself (no room to brake).
[[nodiscard]] TimedMotion timed_motion(const Robot& robot, const std::vector<PrescribedMotion>& motions,
                                       const TimingOptions& options = {});

}  // namespace joulepath
