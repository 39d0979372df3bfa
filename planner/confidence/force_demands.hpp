#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "model/limit_table.hpp"
#include "planner/confidence/plan_course.hpp"
#include "planner/motion/path_motion.hpp"

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

/// What a planned motion, tracked exactly, uses of the limits of motors, battery and tires, for other plants
/// than the planned one. Looked at are both ends and the middle of every segment that the largest errors
/// together may saturate, but for those below another one, whatever the errors are. It keeps a reference to
/// the plan.
class ForceDemands {
 public:
  ForceDemands(const Plan& plan, const Robot& robot, const DrawnPlant& nominal, const ErrorPlants& errors);

  /// Greatest uses by the nominal plant.
  const ForceUses& nominal() const { return nominal_; }

  /// Greatest uses by derivatives for each column of errors (PlantDraw).
  [[nodiscard]] std::vector<ForceUses> estimate(const Eigen::MatrixXd& errors) const;

  /// Greatest uses by plants, whose errors are the columns of `errors`: the model at the places where the
  /// derivatives find the greatest ones of each limit and side, on each stretch.
  [[nodiscard]] std::vector<ForceUses> of(const std::vector<DrawnPlant>& plants,
                                          const Eigen::MatrixXd& errors) const;

  /// The limits of a leg for a plant, the battery's own included.
  [[nodiscard]] Limits limits_on(std::size_t leg, const Plant& plant) const;

 private:
  struct Place {
    std::size_t leg{};
    std::size_t stretch{};  ///< counted over the mission
    BodyMotion<double> motion{};
    Site site{};
    double speed_gain_m_s2{};
  };
  /// A limit, for one wheel where it is one of wheels.
  struct Row {
    std::size_t limit{};
    Side side{};
  };
  static const std::vector<Row>& rows();
  /// The critical places of one row: uses, and their changes with one sigma of each error (a row each). A
  /// place whose force may change its sign stands there twice, with a use below zero for the other sign.
  struct Linear {
    std::vector<std::size_t> place{};
    std::vector<Eigen::Index> stretch_end{};  ///< the first place after each stretch
    Eigen::VectorXd use{};
    Eigen::MatrixXd slope{};  ///< a row each

    Eigen::MatrixXd at(const Eigen::MatrixXd& errors) const { return (slope * errors).colwise() + use; }
  };

  std::vector<Place> all_places(const Plant& plant) const;
  static double use_of(const Row& row, const LimitState& state, const Limits& limits);
  static LimitState state_at(const Place& place, const Plant& plant) {
    return limit_state(plant, place.motion, place.site, place.speed_gain_m_s2, 0.0);
  }
  /// Uses of each row at a leg's places, by a plant.
  Eigen::MatrixXd uses_by(const DrawnPlant& plant, std::size_t leg, const std::vector<Place>& places) const;
  void linearize(std::size_t leg, const DrawnPlant& nominal, const ErrorPlants& errors,
                 const std::vector<Place>& places);
  /// What is known of the places of a leg and one row: uses by the nominal plant, their changes with one
  /// sigma of each error, and uses by the far plants, two columns for each error.
  struct Uses {
    Eigen::VectorXd nominal{};
    Eigen::MatrixXd slope{}, far{};
  };
  void append_critical(Linear& linear, std::size_t first_place, const Uses& uses,
                       const Eigen::MatrixXd& factor);
  /// The places of the greatest estimated uses on each stretch.
  static void append_greatest(const Linear& linear, const double* use, std::vector<std::size_t>& places);
  ForceUses uses_at(const std::vector<std::size_t>& places, const DrawnPlant& plant) const;

  const Plan& plan_;
  std::vector<Limits> limits_{};  ///< of each leg
  std::vector<Place> places_{};
  std::vector<Linear> linear_{};  ///< of each row
  ForceUses nominal_{};
};

}  // namespace joulepath
