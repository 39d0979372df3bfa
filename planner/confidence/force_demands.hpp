#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "model/limit_table.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// The limits whose use depends on the plant and not on the tracked motion alone.
inline constexpr std::size_t kForceLimits = [] {
  std::size_t count = 0;
  for (const Limit& row : kLimits) count += row.of_forces ? 1 : 0;
  return count;
}();
[[nodiscard]] const std::array<const Limit*, kForceLimits>& force_limits();

/// Use of each of force_limits(): above 1 it saturates.
using ForceUses = std::array<double, kForceLimits>;

/// The plants with one sigma more and one less of each error of a draw.
using ShiftedPlants = std::vector<std::array<Plant, 2>>;

/// What a planned motion, tracked exactly, uses of the limits of motors, battery and tires, for other plants
/// than the planned one. Looked at are both ends and the middle of every segment that three times the effect
/// of all sigmas may saturate. It keeps references to plan and plant.
class ForceDemands {
 public:
  ForceDemands(const Plan& plan, const Robot& robot, const Plant& plant, const ShiftedPlants& shifted);

  /// Greatest uses by the nominal plant.
  const ForceUses& nominal() const { return nominal_; }

  /// Greatest uses by derivatives, of errors in sigmas.
  [[nodiscard]] ForceUses estimate(const Eigen::VectorXd& sigmas) const;

  /// Greatest uses by a plant: the model at the places where the derivatives find the greatest ones.
  [[nodiscard]] ForceUses of(const Plant& plant, const Eigen::VectorXd& sigmas) const;

  /// The limits of a leg for a plant, the battery's own included.
  [[nodiscard]] Limits limits_on(std::size_t leg, const Plant& plant) const;

 private:
  struct Place {
    std::size_t leg{};
    BodyMotion<double> motion{};
    Site site{};
    double speed_gain_m_s2{};
  };
  /// The critical places of one limit: uses, and their changes with one sigma of each error (a row each).
  struct Linear {
    std::vector<std::size_t> place{};
    Eigen::VectorXd use{};
    Eigen::MatrixXd slope{};
  };

  std::vector<Place> all_places() const;
  void append_stretch(std::size_t leg, const StretchPlan& stretch, const PathMotion& motion,
                      std::vector<Place>& places) const;
  /// Uses of each limit (a row each) at a leg's places, by a plant.
  Eigen::MatrixXd uses_by(const Plant& plant, std::size_t leg, const std::vector<Place>& places) const;
  ForceUses uses_at(const Place& place, const Plant& plant, const Limits& limits) const;
  void linearize(std::size_t leg, const ShiftedPlants& shifted, const std::vector<Place>& places);

  const Plan& plan_;
  const Plant& plant_;
  std::vector<Limits> limits_{};  ///< of each leg
  std::vector<Place> places_{};
  std::array<Linear, kForceLimits> linear_{};
  ForceUses nominal_{};
};

}  // namespace joulepath
