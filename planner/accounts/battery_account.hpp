#pragma once

#include "planner/accounts/stretch_account.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// State of charge along a plan, with the loss in the internal resistance; absent where the robot file
/// gives no capacity. At legs with a charger the dwell charges, up to a fraction. The 95 % interval comes
/// from the robot file's uncertainty, carried to the energy to first order; missions per charge count down to
/// the reserve, at the upper bound. Fills the plan's sigmas and what its legs charged.
[[nodiscard]] std::optional<BatteryAccount> battery_account(Plan& plan, const UncertainPlant& plant,
                                                            double start_fraction,
                                                            double charge_to_fraction = 1.0);

/// The verdict where the reserve would be touched.
[[nodiscard]] std::optional<Infeasibility> battery_too_small(const Plan& plan, const Plant& plant);

/// 1-sigma of the energy (J) of a plan and of each of its legs: root of the sum of squares over the entries
/// of `uncertainty:`, each carried through the power model along the planned motion by central differences.
/// Legs err together, so the plan's is more than the root of the legs' squares.
void find_energy_sigmas(Plan& plan, const UncertainPlant& plant);

}  // namespace joulepath
