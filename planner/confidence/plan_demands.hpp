#pragma once

#include <vector>

#include "planner/confidence/force_demands.hpp"
#include "planner/confidence/plan_energy.hpp"
#include "planner/confidence/plant_draws.hpp"

namespace joulepath {

/// What the motion of a plan takes from a plant.
struct PlanDemand {
  ForceUses use{};
  double least_fraction{1.0};  ///< state of charge
};

/// Evaluates the planned motion, tracked exactly, for drawn plants. The model's own error, `model_energy`,
/// acts as one torque more of dry friction at both wheels, the same over the mission, that changes its energy
/// of motion by so much. It keeps references to all arguments.
class PlanDemands {
 public:
  PlanDemands(const Plan& plan, const Robot& robot, const Plant& plant, const ChargeStates& charge);

  [[nodiscard]] PlanDemand nominal() const { return {forces_.nominal(), fraction_}; }

  /// By derivatives, for each column of errors (PlantDraw).
  [[nodiscard]] std::vector<PlanDemand> estimate(const Eigen::MatrixXd& errors) const;

  /// By the model, for the plants of such columns; the state of charge by derivatives where they leave no
  /// doubt that the reserve is kept.
  [[nodiscard]] std::vector<PlanDemand> of(const Eigen::MatrixXd& errors, const PlantDraws& draws) const;

  /// The plant of a draw, the model's own error included.
  [[nodiscard]] Plant plant_of(const PlantDraw& draw) const {
    return with_model_error(draw.plant, draw.errors[model_error_]);
  }
  [[nodiscard]] Limits limits_on(std::size_t leg, const Plant& plant) const {
    return forces_.limits_on(leg, plant);
  }

 private:
  double model_friction_Nm(double sigma) const;
  /// A plant with so many sigmas of the model's own error.
  Plant with_model_error(Plant plant, double sigmas) const;
  /// Each error of so many sigmas more and less; of an effect that may be absent: without it, and with it.
  ShiftedPlants shifted(double sigmas) const;
  double estimated_fraction(const Eigen::VectorXd& errors) const;

  const Robot& robot_;
  const Plant& plant_;
  ChargeStates charge_;
  PlanEnergy energy_;
  Eigen::Index model_error_{};  ///< place of the model's own error
  double model_friction_Nm_{};  ///< of one sigma of the model's own error
  ErrorPlants errors_;
  ForceDemands forces_;
  double fraction_{1.0};                  ///< the nominal plant's least state of charge
  Eigen::VectorXd fraction_per_sigma_{};  ///< none where the battery has no capacity
  /// By how much the state of charge falls at most, for one sigma more and less of each error (a row each):
  /// by derivatives, or by the largest error that is drawn.
  Eigen::MatrixX2d fall_per_sigma_{};
};

}  // namespace joulepath
