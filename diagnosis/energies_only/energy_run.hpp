#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/prediction/prediction.hpp"

namespace joulepath {

/// Energies of one run: of the drives, each wheel's positive power and what its regeneration returns, and at
/// the battery's terminals, standby included.
struct RunJoules {
  Sided<double> wheel_J{};
  double battery_J{};
};

/// A prescribed motion as the robot may have driven it: what `predict` works on, at the middle of each step.
struct DrivenMotion {
  RunSignals signals{};
  Eigen::VectorXd step_s{};
};

/// How a drive may differ from its prescription; each a common factor of all runs.
enum class MotionDoubt { deceleration, start_speed };
inline constexpr std::array kMotionDoubts{MotionDoubt::deceleration, MotionDoubt::start_speed};

/// A run of which only the energy was measured.
struct EnergyRun {
  std::size_t run_index{};
  std::string name{};
  DrivenMotion motion{};
  std::array<std::array<DrivenMotion, 2>, kMotionDoubts.size()> doubted{};  ///< one sigma less, one more
  std::optional<Sided<double>> wheel_J{};
  std::optional<double> battery_J{};  ///< counts where the wheels' energy is not given
  double payload_kg{};
  double acceleration_m_s2{};
  std::string path{};  ///< "straight", "curve to the left", "spin", ...

  double measured_J() const { return wheel_J ? wheel_J->left + wheel_J->right : *battery_J; }
  double of(const RunJoules& joules) const {
    return wheel_J ? joules.wheel_J.left + joules.wheel_J.right : joules.battery_J;
  }
};

/// A run that is a motion with an energy and no log.
[[nodiscard]] bool is_energy_run(const Run& run);

/// The dataset's runs without a log, in its order. Throws ConfigError with the run's place where its motion
/// cannot be driven.
[[nodiscard]] std::vector<EnergyRun> energy_runs(const Dataset& dataset);

/// The energy of a motion by a model.
[[nodiscard]] RunJoules joules_of(const DrivenMotion& motion, const ModelPoint& point);

/// What is compared of a run: sum of the wheels, right less left; or the battery's energy alone (J).
[[nodiscard]] Eigen::VectorXd energy_rows(const EnergyRun& run, const RunJoules& joules);
[[nodiscard]] Eigen::VectorXd measured_rows(const EnergyRun& run);

}  // namespace joulepath
