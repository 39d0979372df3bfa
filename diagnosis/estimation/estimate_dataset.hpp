#pragma once

#include "diagnosis/values/dataset.hpp"
#include "model/estimate.hpp"

namespace joulepath {

/// One run: what the model says that it takes, and what was measured.
struct RunEstimate {
  std::string name{};
  EnergyEstimate estimate{};
  std::optional<Sided<double>> measured_motor_J{};
  std::optional<double> measured_battery_J{};
  /// (estimated - measured)/measured, sum of both wheels; at the battery where only it is measured.
  std::optional<double> error{};
  double terminals_J{};  ///< estimated, standby included
  double sigma_J{};      ///< from the robot file's uncertainty
  double upper_95_J{};   ///< that the battery must be able to give, internal loss included
  double capacity_Wh{};  ///< of a battery that keeps its reserve
};

struct DatasetEstimate {
  std::vector<RunEstimate> runs{};
  std::size_t compared{};  ///< runs with something measured
  double fitness{};        ///< share of them with an error under 10 %      [P1, Eq. (33)]
  double mean_error{};
  std::optional<double> model_error{};  ///< rms of the errors; empty below kLeastRunsToCompare compared runs
  double regeneration_efficiency{};     ///< with which braking power counts, estimated and measured alike
};

inline constexpr std::size_t kLeastRunsToCompare = 3;
inline constexpr double kFitnessError = 0.10;

/// Energy of every run from its motion alone, against what was measured.
///
/// Upper bound: E + loss + 1.645 sqrt(sigma^2 + (model_error E)^2): one-sided 95 % of a normal
/// distribution; sigma from the robot file's uncertainty, model_error from the dataset's own runs.
/// Throws ConfigError at a run whose motion cannot be read.
[[nodiscard]] DatasetEstimate estimate_dataset(const Dataset& dataset, const EstimateOptions& options = {});

}  // namespace joulepath
