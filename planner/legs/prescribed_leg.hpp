#pragma once

#include "model/sampled_motion.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// Joules by cause of a prescribed leg's motion, without dwell.
[[nodiscard]] EnergyByCause prescribed_energy(const LegPlan& leg, const Plant& plant);

/// A leg whose motion is prescribed: nothing is optimized. Its energy is left to prescribed_energy(), which
/// needs the departure and the memories of the effects.
/// Throws ConfigError at the leg's marks where the prescription makes no sense.
[[nodiscard]] LegPlan prescribed_leg(const LegRequest& leg, const Plant& plant, const Pose& start);

}  // namespace joulepath
