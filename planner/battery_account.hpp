#pragma once

#include "planner/plan.hpp"

namespace joulepath {

/// State of charge along a plan, with the loss in the internal resistance; absent where the robot file
/// gives no capacity. The 95 % interval comes from the robot file's uncertainty, carried to the energy
/// to first order; missions per charge count down to the reserve, at the upper bound.
[[nodiscard]] std::optional<BatteryAccount> battery_account(Plan& plan, const Plant& plant,
                                                            double start_fraction);

/// The verdict where the reserve would be touched.
[[nodiscard]] std::optional<Infeasibility> battery_too_small(const Plan& plan, const Plant& plant);

/// 1-sigma of a plan's energy (J): root of the sum of squares over the entries of `uncertainty:`, each
/// carried through the power model along the planned motion by central differences.
[[nodiscard]] double energy_sigma_J(const Plan& plan, const Plant& plant);

}  // namespace joulepath
