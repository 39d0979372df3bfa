#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "model/limit_table.hpp"
#include "model/quadrature.hpp"
#include "planner/confidence/plant_draws.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// The limits whose use depends on the plant and not on the tracked motion alone.
inline constexpr std::size_t kForceLimits = [] {
  std::size_t count = 0;
  for (const Limit& row : kLimits) count += row.of_forces ? 1 : 0;
  return count;
}();
[[nodiscard]] const std::array<const Limit*, kForceLimits>& force_limits();

/// What the motion of a plan takes from a plant.
struct PlanDemand {
  std::array<double, kForceLimits> use{};  ///< greatest use of each of force_limits(); above 1 it saturates
  double least_fraction{1.0};              ///< state of charge
};

/// States of charge at the start and after a stop at a charger.
struct ChargeStates {
  double start_fraction{1.0};
  double to_fraction{};
};

/// Evaluates the planned motion, tracked exactly, for other plants than the planned one. Limits are checked
/// at both ends and in the middle of every segment where the nominal plant, with three times the effect of
/// all sigmas, uses them up. The state of charge comes from the energy integral of each leg; by its
/// derivatives where these leave no doubt that the reserve is kept. The model's own error, `model_energy`,
/// acts as one torque more of dry friction at both wheels, the same over the mission, that changes its energy
/// of motion by so much. It keeps references to all arguments.
class PlanDemands {
 public:
  PlanDemands(const Plan& plan, const Robot& robot, const Plant& plant, ChargeStates charge);

  const PlanDemand& nominal() const { return nominal_; }
  [[nodiscard]] PlanDemand of(const PlantDraw& draw) const;

  /// The plant of a draw, the model's own error included.
  [[nodiscard]] Plant plant_of(const PlantDraw& draw) const {
    return with_model_error(draw.plant, draw.sigmas.back());
  }

  /// The limits of a leg for a plant, the battery's own included.
  [[nodiscard]] Limits limits_on(std::size_t leg, const Plant& plant) const;

 private:
  struct Place {
    std::size_t leg{};
    BodyMotion<double> motion{};
    Site site{};
    double speed_gain_m_s2{};
  };
  using Uses = std::array<double, kForceLimits>;

  std::vector<Place> all_places() const;
  void collect_nodes();
  void find_model_friction();
  /// A plant with so many sigmas of the model's own error.
  Plant with_model_error(Plant plant, double sigmas) const;
  /// One sigma more and one less of each error of a draw.
  std::vector<std::array<Plant, 2>> shifted() const;
  void find_fractions();
  static Uses uses_at(const Place& place, const Plant& plant, const Limits& limits);
  /// Keeps the places that some plant within three times the sum of all sigmas might saturate.
  void keep_critical(const std::vector<Place>& all);
  /// What a leg draws (J) from the battery, without standby and with the loss in the battery.
  struct LegDrain {
    double motion_J{};
    double loss_J{};
  };
  LegDrain drain_on(std::size_t leg, const Plant& plant) const;
  double least_fraction(const Plant& plant) const;
  double estimated_fraction(const PlantDraw& draw) const;

  const Plan& plan_;
  const Robot& robot_;
  const Plant& plant_;
  ChargeStates charge_;
  std::vector<Limits> limits_{};                  ///< of each leg
  std::vector<Place> places_{};                   ///< critical ones
  std::vector<std::vector<EnergyNode>> nodes_{};  ///< of each leg
  double model_friction_Nm_{};                    ///< of one sigma of the model's own error
  std::vector<double> fraction_per_sigma_{};      ///< change of the least state of charge
  PlanDemand nominal_{};
};

}  // namespace joulepath
