#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/values/dataset.hpp"

namespace joulepath {

/// A run and a robot that was fitted to other runs.
struct HeldOutRun {
  const Run& run;
  Robot robot{};
};

/// With fewer held-out runs no model error is stated: with 6, Student's t widens it by 31 %, with 3 by 120 %.
inline constexpr std::size_t kLeastHeldOutRuns = 6;

/// (measured - estimated)/estimated energy of a run's motion: of both motors, or at the battery without
/// standby where nothing measures the motors; nothing where the run measures neither. Throws ConfigError if
/// the run's motion cannot be read.
[[nodiscard]] std::optional<double> motion_energy_error(const Run& run, const Robot& robot);

/// Writes the model's error into the robot's `uncertainty:` as `model_energy`, if there are enough runs: the
/// root mean square of such errors, times Student's t over the normal distribution's quantile, so that an
/// interval of 95 % is one. Returns a sentence that says so, or what is missing. The error holds the scatter
/// of one run from the next, of the readings too; runs of one day do not show how days differ.
std::string write_model_energy(const std::vector<double>& errors, Robot& robot);
std::string write_model_energy(const std::vector<HeldOutRun>& runs, Robot& robot);

}  // namespace joulepath
