#include "planner/legs/prescribed_leg.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/motions.hpp"
#include "planner/legs/leg_motion.hpp"

namespace joulepath {

namespace {

/// Samples of a prescribed motion at most, beside those where its acceleration changes. Speeds are linear
/// between samples, so that energy and time stay exact where a long motion has a long period.
constexpr double kMostSamples = 2e4;

TimedMotion sampled_motion(const LegRequest& leg, const Plant& plant, const Pose& start) {
  TimingOptions options{.start = start, .payload_kg = leg.payload.from_kg};
  const double usual_s = std::exchange(options.sample_period_s, kNoLimit);
  const Trajectory shape = timed_motion(plant.robot, {*leg.motion}, options).trajectory;
  if (shape.size() == 0) return {};
  options.sample_period_s = std::max(usual_s, (shape.time_s.back() - shape.time_s.front()) / kMostSamples);
  return timed_motion(plant.robot, {*leg.motion}, options);
}

}  // namespace

EnergyByCause prescribed_energy(const LegPlan& leg, const Plant& plant) {
  if (leg.prescribed->size() == 0) return {};
  const SampledMotion motion = prescribed_motion(leg, plant);
  return energy_between(motion, motion.start_s(), motion.end_s());
}

LegPlan prescribed_leg(const LegRequest& leg, const Plant& plant, const Pose& start) {
  LegPlan planned{.to = "motion",
                  .path_source = "prescribed",
                  .status = SolveStatus::feasible,
                  .payload = leg.payload,
                  .dwell_s = leg.dwell_s};
  try {
    planned.prescribed = sampled_motion(leg, plant, start).trajectory;
  } catch (const ConfigError& error) {
    ConfigError::Detail detail = error.detail();
    detail.mark = leg.marks.at("motion");
    detail.key = leg.marks.key_path(detail.key.empty() ? "motion" : detail.key);
    throw ConfigError(detail);
  }
  const Trajectory& motion = *planned.prescribed;
  if (motion.size() == 0) return planned;
  planned.duration_s = motion.time_s.back() - motion.time_s.front();
  if (!motion.arc_length_m.empty()) planned.distance_m = motion.arc_length_m.back();
  return planned;
}

}  // namespace joulepath
