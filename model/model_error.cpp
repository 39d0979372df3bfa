#include "model/model_error.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/normal_quantiles.hpp"
#include "model/printable.hpp"
#include "model/student_t.hpp"

namespace joulepath {
namespace {

double sum_of_error_squares(const std::vector<MotionEnergyError>& values) {
  double sum = 0.0;
  for (const MotionEnergyError& value : values) sum += value.error * value.error;
  return sum;
}

/// Without the runs that hardly move.
std::vector<MotionEnergyError> of_moving_runs(std::vector<MotionEnergyError> errors) {
  constexpr double kLeastShare = 0.1;
  if (errors.empty()) return errors;
  const auto less = [](const MotionEnergyError& a, const MotionEnergyError& b) {
    return a.energy_J < b.energy_J;
  };
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end(), less);
  const double least_J = kLeastShare * middle->energy_J;
  std::erase_if(errors, [&](const MotionEnergyError& value) { return value.energy_J < least_J; });
  return errors;
}

}  // namespace

std::string write_model_energy(std::vector<MotionEnergyError> errors, Robot& robot) {
  errors = of_moving_runs(std::move(errors));
  const std::size_t count = errors.size();
  const std::string runs = std::to_string(count) + " held-out runs";
  if (count < kLeastHeldOutRuns)
    return "model_energy is not measured: " + runs + " with the energy of their motion, " +
           std::to_string(kLeastHeldOutRuns) + " are needed" +
           (robot.model_energy_sigma() ? "; the robot file's value stays" : "");
  const double n = static_cast<double>(count), rms = std::sqrt(sum_of_error_squares(errors) / n);
  const double wider = student_t_975(n - 1) / kNormal95;
  const double sigma = std::min(wider * rms, 1.0);
  robot.uncertainty["model_energy"] = sigma;
  return "model_energy " + four_digits(sigma) + ": the energies of " + runs + " are off by " +
         four_digits(rms) + " (rms), times Student's t over the normal distribution's";
}

}  // namespace joulepath
