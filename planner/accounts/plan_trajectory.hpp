#pragma once

#include "model/plant.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// A plan over time: uniform samples (50 Hz by default), dwell and waiting included, the last sample at
/// the end. Reads back as a run log; energy_J is what the battery's terminals have given so far.
[[nodiscard]] Trajectory plan_trajectory(const Plan& plan, const Plant& plant, double rate_Hz = 50.0);

}  // namespace joulepath
