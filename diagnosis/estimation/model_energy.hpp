#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/values/dataset.hpp"
#include "model/model_error.hpp"

namespace joulepath {

/// A run and a robot that was fitted to other runs.
struct HeldOutRun {
  const Run& run;
  Robot robot{};
};

/// (measured - estimated)/estimated energy of a run's motion: of both motors, or at the battery without
/// standby where nothing measures the motors; nothing where the run measures neither. Throws ConfigError if
/// the run's motion cannot be read.
[[nodiscard]] std::optional<MotionEnergyError> motion_energy_error(const Run& run, const Robot& robot);

/// Writes the model's error that these runs show, with model/model_error.hpp. A run whose motion cannot be
/// read does not count.
std::string write_model_energy(const std::vector<HeldOutRun>& runs, Robot& robot);

}  // namespace joulepath
