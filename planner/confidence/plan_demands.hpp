#pragma once

#include <array>
#include <string>
#include <vector>

#include "planner/confidence/course_estimate.hpp"
#include "planner/confidence/force_demands.hpp"
#include "planner/confidence/plant_draws.hpp"

namespace joulepath {

/// Limits of a plan whose use depends on the plant: force_limits(), and the windings' temperatures.
inline constexpr std::size_t kUsedLimits = kForceLimits + 1;
inline constexpr std::size_t kWindingLimit = kForceLimits;
[[nodiscard]] std::string used_limit_name(std::size_t i);

/// What the motion of a plan takes from a plant.
struct PlanDemand {
  std::array<double, kUsedLimits> use{};  ///< above 1 a limit saturates, or a winding is too hot
  double least_fraction{1.0};             ///< state of charge
};

/// Evaluates the planned motion, tracked exactly, for drawn plants. The model's own error, `model_energy`,
/// acts as one torque more of dry friction at both wheels, the same over the mission, that changes its energy
/// of motion by so much. It keeps references to all arguments.
class PlanDemands {
 public:
  PlanDemands(const Plan& plan, const Robot& robot, const Plant& plant, const ChargeStates& charge);

  [[nodiscard]] PlanDemand nominal() const { return demand(forces_.nominal(), nominal_.course); }

  /// By derivatives, for each column of errors (PlantDraw).
  [[nodiscard]] std::vector<PlanDemand> estimate(const Eigen::MatrixXd& errors) const;

  /// By the model, for the plants of such columns; charge and heat by derivatives where they leave no doubt
  /// that reserve and windings are kept.
  [[nodiscard]] std::vector<PlanDemand> of(const Eigen::MatrixXd& errors, const PlantDraws& draws) const;

  /// The plant of a draw, the model's own error included, with its course by derivatives.
  [[nodiscard]] DrawnPlant plant_of(const PlantDraw& draw) const;
  [[nodiscard]] Limits limits_on(std::size_t leg, const Plant& plant) const {
    return forces_.limits_on(leg, plant);
  }

 private:
  double model_friction_Nm(double sigma) const;
  /// A plant with so many sigmas of the model's own error.
  Plant with_model_error(Plant plant, double sigmas) const;
  /// Each error of so many sigmas more and less; of an effect that may be absent: without it, and with it.
  ShiftedPlants shifted(double sigmas) const;
  static PlanDemand demand(const ForceUses& forces, const PlanCourse& course);

  const Robot& robot_;
  const Plant& plant_;
  PlanCourses courses_;
  DrawnPlant nominal_;
  Eigen::Index model_error_{};  ///< place of the model's own error
  double model_friction_Nm_{};  ///< of one sigma of the model's own error
  ErrorPlants errors_;
  ForceDemands forces_;
  CourseEstimate course_;
};

}  // namespace joulepath
