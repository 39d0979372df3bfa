#pragma once

#include "planner/values/plan.hpp"

namespace joulepath {

inline constexpr const char* kWindingTemperature = "winding_temperature";  ///< a limit's name

/// Temperature of both windings over a plan, from ambient at its start: one thermal node per motor, heated by
/// the copper loss at the resistance that follows the temperature (rise_after_K()). Absent where the robot's
/// motors state no `thermal`.
[[nodiscard]] std::optional<WindingAccount> winding_account(const Plan& plan, const Plant& plant);

/// Temperatures (C) of one winding of a plan, as in the account, at times (s) that rise.
[[nodiscard]] std::vector<double> winding_temperatures_C(const Plan& plan, const Plant& plant, Side side,
                                                         const std::vector<double>& times_s);

/// The verdict where a winding becomes hotter than its `max_winding_C`, less its margin.
[[nodiscard]] std::optional<Infeasibility> winding_too_hot(const Plan& plan, const Robot& robot);

/// Whether this is the verdict on a plan.
[[nodiscard]] bool is_too_hot(const Plan& plan);

}  // namespace joulepath
