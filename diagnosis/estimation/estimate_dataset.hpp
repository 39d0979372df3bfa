#pragma once

#include "diagnosis/values/dataset.hpp"
#include "model/estimate.hpp"

namespace joulepath {

/// Estimated and measured energy of one run.
struct RunEstimate {
  std::string name{};
  EnergyEstimate estimate{};
  std::optional<Sided<double>> measured_motor_J{};
  std::optional<double> measured_battery_J{};
  /// (estimated - measured)/measured, sum of both wheels; at the battery where nothing else is measured.
  std::optional<double> error{};
  double terminals_J{};  ///< estimated, standby included
  double sigma_J{};      ///< from the robot file's uncertainty
  double upper_95_J{};   ///< energy that the battery must provide, internal loss included
  double capacity_Wh{};  ///< capacity of a battery that keeps its reserve
};

struct DatasetEstimate {
  std::vector<RunEstimate> runs{};
  std::size_t compared{};  ///< runs with a measured energy
  double fitness{};        ///< share of these runs with an error under 10 %      [P1, Eq. (33)]
  double mean_error{};
  std::optional<double> model_error{};  ///< rms of the errors; empty below kLeastRunsToCompare compared runs
  double regeneration_efficiency{};     ///< applied to estimated and measured braking power alike
};

inline constexpr std::size_t kLeastRunsToCompare = 3;
inline constexpr double kFitnessError = 0.10;

/// Estimates the energy of every run from its motion and compares it with the measured energy.
///
/// Upper bound: E + loss + 1.645 sqrt(sigma^2 + (model_error E)^2), the one-sided 95 % quantile of a normal
/// distribution. sigma comes from the robot file's uncertainty, model_error from the dataset's runs. Throws
/// ConfigError at a run whose motion cannot be read.
[[nodiscard]] DatasetEstimate estimate_dataset(const Dataset& dataset, const EstimateOptions& options = {});

}  // namespace joulepath
