#include "diagnosis/estimation/model_energy.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "diagnosis/estimation/run_motion.hpp"
#include "model/normal_quantiles.hpp"
#include "model/printable.hpp"

namespace joulepath {
namespace {

double sum_of_squares(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return sum;
}

}  // namespace

std::optional<double> motion_energy_error(const Run& run, const Robot& robot) {
  const RunMotion motion = run_motion(run, robot);
  const EnergyEstimate estimate = estimate_energy(make_plant(robot), motion.trajectory, motion.options);
  const MeasuredEnergy measured = measured_energy(run, robot);
  const double motors_J = estimate.counted_J.left + estimate.counted_J.right;
  if (measured.motor_J && motors_J > 0)
    return (measured.motor_J->left + measured.motor_J->right) / motors_J - 1;
  const double motion_J = estimate.by_cause.motion_J();
  if (!measured.battery_J || !(motion_J > 0)) return std::nullopt;
  return (*measured.battery_J - estimate.by_cause.total_J()) / motion_J;
}

std::string write_model_energy(const std::vector<double>& errors, Robot& robot) {
  const std::size_t count = errors.size();
  const std::string runs = std::to_string(count) + " held-out runs";
  if (count < kLeastHeldOutRuns)
    return "model_energy is not measured: " + runs + " with the energy of their motion, " +
           std::to_string(kLeastHeldOutRuns) + " are needed" +
           (robot.model_energy_sigma() ? "; the robot file's value stays" : "");
  const double n = static_cast<double>(count), rms = std::sqrt(sum_of_squares(errors) / n);
  const double wider = boost::math::quantile(boost::math::students_t(n - 1), 0.975) / kNormal95;
  robot.uncertainty["model_energy"] = std::min(wider * rms, 1.0);
  return "model_energy " + four_digits(wider * rms) + ": the energies of " + runs + " are off by " +
         four_digits(rms) + " (rms), times Student's t over the normal distribution's";
}

std::string write_model_energy(const std::vector<HeldOutRun>& runs, Robot& robot) {
  std::vector<double> errors;
  for (const HeldOutRun& held_out : runs)
    if (const auto error = motion_energy_error(held_out.run, held_out.robot); error && std::isfinite(*error))
      errors.push_back(*error);
  return write_model_energy(errors, robot);
}

}  // namespace joulepath
