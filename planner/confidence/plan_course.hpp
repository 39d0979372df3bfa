#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "model/quadrature.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// States of charge at the start and after a stop at a charger.
struct ChargeStates {
  double start_fraction{1.0};
  double to_fraction{};
};

/// Charge and heat on a leg.
struct LegCourse {
  double least_fraction{1.0};                 ///< state of charge
  Sided<double> resistance_factor{1.0, 1.0};  ///< of the copper, its mean by copper loss
};

/// Charge and heat over a plan.
struct PlanCourse {
  double least_fraction{1.0};     ///< state of charge after a leg; 1 where the battery has no capacity
  double winding_use{};           ///< greatest rise of a winding's temperature over the one that is allowed
  std::vector<LegCourse> legs{};  ///< none where nothing drifts
};

/// A plant and what it makes of a plan.
struct DrawnPlant {
  Plant plant{};
  PlanCourse course{};

  /// The plant as it is on a leg, the k-th one of the plan.
  [[nodiscard]] Plant on(const LegPlan& leg, std::size_t k) const;
};

/// Pairs of plants with more and with less of each error of a draw.
using ShiftedPlants = std::vector<std::array<DrawnPlant, 2>>;

/// The errors of draws: what one sigma of each does, what the largest one does that is drawn (kReach sigmas),
/// and a factor that makes errors out of independent standard normal numbers.
struct ErrorPlants {
  ShiftedPlants near{}, far{};
  std::size_t one_sided{};  ///< of these pairs, the last ones: without an effect, and the nominal plant
  Eigen::MatrixXd factor{};
};
inline constexpr double kReach = 6.0;  ///< sigmas of an error, or of a use, that no draw exceeds

/// Energy, charge and heat of a planned motion, tracked exactly, for other plants than the planned one. It
/// keeps a reference to the plan.
class PlanCourses {
 public:
  PlanCourses(const Plan& plan, const Plant& plant, const ChargeStates& charge);

  /// Energy of motion (J) at the battery's terminals, without standby and dwell.
  [[nodiscard]] double motion_J(const Plant& plant) const;

  [[nodiscard]] PlanCourse of(const Plant& plant) const;

  /// Whether courses depend on the plant.
  [[nodiscard]] bool are_followed() const { return has_capacity_ || drifts_; }

 private:
  struct LegDrain {
    double motion_J{};
    double loss_J{};  ///< in the battery, at rest too
  };
  /// By a plant as it is on the leg.
  LegDrain drain_on(std::size_t leg, const Plant& here) const;
  void follow_heat(DrawnPlant& drawn) const;
  void follow_charge(DrawnPlant& drawn) const;
  /// Energy (J) that the battery gives until the end of a leg's stop.
  double drawn_J(std::size_t leg, const Plant& here) const;

  const Plan& plan_;
  ChargeStates charge_;
  bool has_capacity_{};
  bool drifts_{};
  std::vector<std::vector<EnergyNode>> nodes_{};  ///< of each leg
};

}  // namespace joulepath
