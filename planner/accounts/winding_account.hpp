#pragma once

#include "planner/values/plan.hpp"

namespace joulepath {

/// Temperature of both windings over a plan, from ambient at its start: one thermal node per motor, heated by
/// the copper loss at the resistance that follows the temperature (rise_after_K()). Absent where the robot's
/// motors state no `thermal`.
[[nodiscard]] std::optional<WindingAccount> winding_account(const Plan& plan, const Plant& plant);

/// Temperature of one winding over a plan, as in the account, at about so many instants.
struct WindingTrace {
  std::vector<double> time_s{};
  std::vector<double> temperature_C{};
};
[[nodiscard]] WindingTrace winding_trace(const Plan& plan, const Plant& plant, Side side,
                                         std::size_t most_rows);

/// The verdict where a winding becomes hotter than its `max_winding_C`.
[[nodiscard]] std::optional<Infeasibility> winding_too_hot(const Plan& plan);

/// Whether this is the verdict on a plan.
[[nodiscard]] bool is_too_hot(const Plan& plan);

}  // namespace joulepath
