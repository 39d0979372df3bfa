#pragma once

#include "planner/values/plan.hpp"

namespace joulepath {

/// Body motion and place at an instant of a sampled motion whose speeds are linear between samples.
struct SampledState {
  BodyMotion<double> motion{};
  Pose pose{};
  double arc_length_m{};
  double curvature_per_m{};
};
[[nodiscard]] SampledState sampled_state(const Trajectory& trajectory, double time_s);

/// Joules by cause of a prescribed leg's motion (without dwell) between two instants, counted from its
/// departure; three Gauss points in every interval of its samples.
[[nodiscard]] EnergyByCause prescribed_energy(const LegPlan& leg, const Plant& plant, double from_s,
                                              double to_s);

/// A leg whose motion is prescribed: nothing is optimized, its energy is accounted for by the same model.
/// Throws ConfigError at the leg's marks where the prescription makes no sense.
[[nodiscard]] LegPlan prescribed_leg(const LegRequest& leg, const Plant& plant, const Pose& start);

}  // namespace joulepath
