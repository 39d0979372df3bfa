#pragma once

#include <vector>

#include "model/quadrature.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// States of charge at the start and after a stop at a charger.
struct ChargeStates {
  double start_fraction{1.0};
  double to_fraction{};
};

/// The energy of a planned motion, tracked exactly, for other plants than the planned one. It keeps a
/// reference to the plan.
class PlanEnergy {
 public:
  PlanEnergy(const Plan& plan, const Plant& plant);

  /// Energy of motion (J) at the battery's terminals, without standby and dwell.
  [[nodiscard]] double motion_J(const Plant& plant) const;

  /// The least state of charge on the way; 1 where the battery has no capacity.
  [[nodiscard]] double least_fraction(const Plant& plant, const ChargeStates& charge) const;

 private:
  struct LegDrain {
    double motion_J{};
    double loss_J{};  ///< in the battery, at rest too
  };
  LegDrain drain_on(std::size_t leg, const Plant& plant) const;

  const Plan& plan_;
  std::vector<std::vector<EnergyNode>> nodes_{};  ///< of each leg
};

}  // namespace joulepath
