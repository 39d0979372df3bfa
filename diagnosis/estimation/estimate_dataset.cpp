#include "diagnosis/estimation/estimate_dataset.hpp"

#include <cmath>

#include "diagnosis/estimation/run_motion.hpp"
#include "model/normal_quantiles.hpp"
#include "model/watt_hours.hpp"

namespace joulepath {
namespace {

RunEstimate estimate_run(const Run& run, const Robot& robot, const Plant& plant,
                         const EstimateOptions& options) {
  RunEstimate result{.name = run.name};
  try {
    const RunMotion motion = run_motion(run, robot, options);
    result.estimate = estimate_energy(plant, motion.trajectory, motion.options);
    result.sigma_J = energy_sigma_J(robot, motion.trajectory, motion.options);
  } catch (const ConfigError& error) {
    ConfigError::Detail detail = error.detail();
    detail.mark = run.mark;
    throw ConfigError(detail);
  }
  result.terminals_J = result.estimate.by_cause.total_J();
  const MeasuredEnergy measured = measured_energy(run, robot);
  result.measured_motor_J = measured.motor_J, result.measured_battery_J = measured.battery_J;
  const auto relative = [](double estimated_J, double measured_J) {
    return measured_J != 0 ? std::optional(estimated_J / measured_J - 1) : std::nullopt;
  };
  if (result.measured_motor_J) {
    const Sided<double>& counted_J = result.estimate.counted_J;
    result.error = relative(counted_J.left + counted_J.right,
                            result.measured_motor_J->left + result.measured_motor_J->right);
  } else if (result.measured_battery_J) {
    result.error = relative(result.terminals_J, *result.measured_battery_J);
  }
  return result;
}

}  // namespace

DatasetEstimate estimate_dataset(const Dataset& dataset, const EstimateOptions& options) {
  const Plant plant = make_plant(dataset.robot);
  DatasetEstimate all{.regeneration_efficiency = dataset.robot.power.regeneration_efficiency};
  double squares = 0;
  std::size_t within = 0;
  for (const Run& run : dataset.runs) {
    all.runs.push_back(estimate_run(run, dataset.robot, plant, options));
    if (!all.runs.back().error) continue;
    const double error = *all.runs.back().error;
    ++all.compared;
    within += std::abs(error) < kFitnessError;
    all.mean_error += error;
    squares += error * error;
  }
  if (all.compared > 0) {
    const double count = static_cast<double>(all.compared);
    all.fitness = static_cast<double>(within) / count;
    all.mean_error /= count;
    if (all.compared >= kLeastRunsToCompare) all.model_error = std::sqrt(squares / count);
  }
  for (RunEstimate& run : all.runs) {
    const double model_J = all.model_error.value_or(0.0) * run.terminals_J;
    run.upper_95_J =
        run.terminals_J + run.estimate.battery_loss_J + kNormal95OneSided * std::hypot(run.sigma_J, model_J);
    run.capacity_Wh = run.upper_95_J / kJoulesPerWh / (1 - dataset.robot.battery.reserve_fraction);
  }
  return all;
}

}  // namespace joulepath
