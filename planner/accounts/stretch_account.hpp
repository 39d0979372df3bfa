#pragma once

#include <array>

#include "model/nuisance.hpp"
#include "model/quadrature.hpp"
#include "planner/cache/answer_cache.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// A plant, and its variants with one uncertain constant shifted.
struct UncertainPlant {
  Plant plant{};
  std::vector<std::array<Plant, 2>> shifted{};  ///< per entry of `uncertainty:`, one sigma more and one less
};
[[nodiscard]] UncertainPlant uncertain(Plant plant);

/// What one sigma of a constant adds to the drives' power (W) at a node, to first order.
[[nodiscard]] double power_shift_W(const std::array<Plant, 2>& shifted, const EnergyNode& node);

/// A plant whose constant is (1 + fraction) times as large.
[[nodiscard]] Plant with_error(Plant plant, const Nuisance& nuisance, double fraction);

/// Computes the accounts of a planned stretch: independent replay, energy by cause, battery loss, and the
/// change by each uncertain constant. `request` and `profile` must be set.
void account_for(StretchPlan& stretch, const UncertainPlant& plant, const SharedAnswers& answers);

/// How far (%) an energy may be above the least one, by a lower bound (J).
[[nodiscard]] double gap_percent(double energy_J, double bound_J);

/// Makes the bound and the gap of an accounted stretch those of its drive and of a wait (s) at its end, for
/// the price (W) of a second beyond standby. A slower drive that uses the waiting time may save that price.
void bound_wait(StretchPlan& stretch, double wait_s, double price_W);

}  // namespace joulepath
