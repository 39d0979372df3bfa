#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/prediction/prediction.hpp"

namespace joulepath {

/// Energies of one run: at the drives (positive and regenerated power of each wheel), and at the battery's
/// terminals, standby included.
struct RunJoules {
  Sided<double> wheel_J{};
  double battery_J{};
};

/// A prescribed motion as the robot may have driven it: the input of `predict`, at the midpoint of each step.
struct DrivenMotion {
  RunSignals signals{};
  Eigen::VectorXd step_s{};
};

/// Possible deviations of a drive from its prescription; each is a factor common to all runs.
enum class MotionDoubt { deceleration, start_speed };
inline constexpr std::array kMotionDoubts{MotionDoubt::deceleration, MotionDoubt::start_speed};

/// A run with a measured energy only.
struct EnergyRun {
  std::size_t run_index{};
  std::string name{};
  DrivenMotion motion{};
  std::array<std::array<DrivenMotion, 2>, kMotionDoubts.size()> doubted{};  ///< at minus and plus one sigma
  std::optional<Sided<double>> wheel_J{};
  std::optional<double> battery_J{};  ///< used where the wheels' energy is not given
  double payload_kg{};
  double acceleration_m_s2{};
  std::string path{};  ///< "straight", "curve to the left", "spin", ...

  double measured_J() const { return wheel_J ? wheel_J->left + wheel_J->right : *battery_J; }
  double of(const RunJoules& joules) const {
    return wheel_J ? joules.wheel_J.left + joules.wheel_J.right : joules.battery_J;
  }
};

/// The dataset's runs without a log, in its order. Throws ConfigError with the run's place where its motion
/// cannot be driven.
[[nodiscard]] std::vector<EnergyRun> energy_runs(const Dataset& dataset);

/// Energies of a motion predicted by a model.
[[nodiscard]] RunJoules joules_of(const DrivenMotion& motion, const ModelPoint& point);

/// Compared values of a run: sum of the wheels and right minus left, or the battery's energy (J).
[[nodiscard]] Eigen::VectorXd energy_rows(const EnergyRun& run, const RunJoules& joules);
[[nodiscard]] Eigen::VectorXd measured_rows(const EnergyRun& run);

}  // namespace joulepath
