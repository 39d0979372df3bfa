#include "diagnosis/estimation/model_energy.hpp"

#include <cmath>
#include <utility>

#include "diagnosis/estimation/run_motion.hpp"
#include "model/config_error.hpp"

namespace joulepath {

std::optional<MotionEnergyError> motion_energy_error(const Run& run, const Robot& robot) {
  const RunMotion motion = run_motion(run, robot);
  const EnergyEstimate estimate = estimate_energy(make_plant(robot), motion.trajectory, motion.options);
  const MeasuredEnergy measured = measured_energy(run, robot);
  const double motors_J = estimate.counted_J.left + estimate.counted_J.right;
  if (measured.motor_J && motors_J > 0)
    return MotionEnergyError{(measured.motor_J->left + measured.motor_J->right) / motors_J - 1, motors_J};
  const double motion_J = estimate.by_cause.motion_J();
  if (!measured.battery_J || !(motion_J > 0)) return std::nullopt;
  return MotionEnergyError{(*measured.battery_J - estimate.by_cause.total_J()) / motion_J, motion_J};
}

std::string write_model_energy(const std::vector<HeldOutRun>& runs, Robot& robot) {
  std::vector<MotionEnergyError> errors;
  for (const HeldOutRun& held_out : runs) {
    try {
      const auto error = motion_energy_error(held_out.run, held_out.robot);
      if (error && std::isfinite(error->error)) errors.push_back(*error);
    } catch (const ConfigError&) {  // its motion cannot be read
    }
  }
  return write_model_energy(std::move(errors), robot);
}

}  // namespace joulepath
