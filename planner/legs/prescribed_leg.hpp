#pragma once

#include "model/sampled_motion.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// Joules by cause of a prescribed leg's motion, without dwell.
[[nodiscard]] EnergyByCause prescribed_energy(const LegPlan& leg, const Plant& plant);

/// A leg with a prescribed motion: nothing is optimized. prescribed_energy() computes its energy later, from
/// the departure and the memories of the effects.
/// Throws ConfigError at the leg's marks if the prescription is invalid.
[[nodiscard]] LegPlan prescribed_leg(const LegRequest& leg, const Plant& plant, const Pose& start);

}  // namespace joulepath
