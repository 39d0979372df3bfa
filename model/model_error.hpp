#pragma once

#include <string>
#include <vector>

#include "model/robot.hpp"

namespace joulepath {

/// With fewer held-out runs no model error is stated: with 6, Student's t widens it by 31 %, with 3 by 120 %.
inline constexpr std::size_t kLeastHeldOutRuns = 6;

/// The error of a held-out run's energy of motion, relative to the estimated energy.
struct MotionEnergyError {
  double error{};
  double energy_J{};  ///< estimated
};

/// Writes the model's error into the robot's `uncertainty:` as `model_energy`, if there are enough runs. A
/// run with less than a tenth of the median energy does not count: it measures sensor offsets. The errors'
/// root mean square is multiplied by Student's t over the normal distribution's quantile, so that an interval
/// of 95 % is one. It holds the scatter of one run from the next, of the readings too; runs of one day do not
/// show how days differ. Returns a sentence that says so, or what is missing.
std::string write_model_energy(std::vector<MotionEnergyError> errors, Robot& robot);

}  // namespace joulepath
