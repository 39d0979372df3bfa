#include "diagnosis/estimation/model_energy.hpp"

#include <cmath>

#include "diagnosis/estimation/run_motion.hpp"
#include "model/model_error.hpp"

namespace joulepath {

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

std::string write_model_energy(const std::vector<HeldOutRun>& runs, Robot& robot) {
  std::vector<double> errors;
  for (const HeldOutRun& held_out : runs)
    if (const auto error = motion_energy_error(held_out.run, held_out.robot); error && std::isfinite(*error))
      errors.push_back(*error);
  return write_model_energy(errors, robot);
}

}  // namespace joulepath
