#pragma once

#include <nlohmann/json_fwd.hpp>

#include "planner/values/plan.hpp"

namespace joulepath::studio {

/// Times at which a plan is drawn: about `count`, including the ends of stretches and of dwells.
[[nodiscard]] std::vector<double> drawn_times_s(const Plan& plan, std::size_t count);

/// The motion of a valid plan at these times: columns with the names of trajectory.csv, `limit` (index into
/// `limits`, -1: none binds) and `limit_use` (of the tightest limit, 1 = at the limit).
[[nodiscard]] nlohmann::json drawn_motion(const Plan& plan, const Plant& plant,
                                          const std::vector<double>& times_s);

/// The 95 % intervals of power and energy along a valid plan, `battery_power_W` and `energy_J`, each with its
/// own `time_s`, `low` and `high`; without those that the robot's file does not state.
[[nodiscard]] nlohmann::json drawn_bands(const Plan& plan, const Plant& plant,
                                         const std::vector<double>& times_s);

/// The names of the limits, in the order of the index `limit`.
[[nodiscard]] nlohmann::json limit_names();

/// The path that a planned leg follows; empty for a prescribed motion.
[[nodiscard]] Path path_of(const LegPlan& leg);

}  // namespace joulepath::studio
