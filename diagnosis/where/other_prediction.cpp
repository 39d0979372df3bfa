#include "diagnosis/where/other_prediction.hpp"

#include <algorithm>

#include "diagnosis/numerics/smoothing.hpp"
#include "diagnosis/where/gap.hpp"

namespace joulepath {
namespace {

std::vector<double> at_times_of(const Trajectory& log, const Trajectory& other,
                                const std::vector<double>& channel) {
  return channel.empty() ? channel : interpolate(other.time_s, channel, log.time_s);
}

/// The run with the other simulator's electrical channels in place of the measured ones.
Run as_predicted(const Run& run) {
  Run result = run;
  Trajectory& log = result.log;
  const Trajectory& other = *run.predicted;
  for (Side side : kSides) {
    log.motor_voltage_V[side] = at_times_of(log, other, other.motor_voltage_V[side]);
    log.motor_current_A[side] = at_times_of(log, other, other.motor_current_A[side]);
    log.motor_power_W[side] = at_times_of(log, other, other.motor_power_W[side]);
  }
  log.battery_voltage_V = at_times_of(log, other, other.battery_voltage_V);
  log.battery_current_A = at_times_of(log, other, other.battery_current_A);
  return result;
}

/// Energies of a run with the other simulator as the model; both 0 where nothing can be compared.
RunEnergy energy_of(const RunSignals& run, const OtherPrediction& other) {
  RunEnergy energy;
  const auto add = [&](const Eigen::VectorXd& measured_W, const Eigen::VectorXd& predicted_W) {
    energy.measured_J += run.period_s * measured_W.sum();
    energy.predicted_J += run.period_s * predicted_W.sum();
  };
  if (!measures_motors(run) && measures_energy(run) && other.battery_power_W.size() > 0)
    add(run.battery_power_W, other.battery_power_W);
  if (!measures_motors(run) || !other.has_motor_power()) return energy;
  for (Side side : kSides)
    if (const Eigen::VectorXd measured_W = measured_power_W(run, side); measured_W.size() > 0)
      add(measured_W, other.power_W[side]);
  return energy;
}

}  // namespace

std::vector<OtherPrediction> other_predictions(const Dataset& dataset, const std::vector<RunSignals>& signals,
                                               const SignalOptions& options) {
  std::vector<OtherPrediction> others(signals.size());
  for (std::size_t r = 0; r < signals.size(); ++r) {
    const Run& run = dataset.runs[signals[r].run_index];
    if (!run.predicted || run.predicted->time_s.empty()) continue;
    RunSignals read = make_run_signals(as_predicted(run), signals[r].run_index, dataset.robot, options);
    others[r] = {.current_A = std::move(read.motor_current_A),
                 .voltage_V = std::move(read.motor_voltage_V),
                 .power_W = std::move(read.motor_power_W),
                 .battery_power_W = std::move(read.battery_power_W)};
  }
  return others;
}

Prediction in_place_of(Prediction ours, const OtherPrediction& other) {
  for (Side side : kSides) {
    if (other.current_A[side].size() > 0) ours.current_A[side] = other.current_A[side];
    if (other.voltage_V[side].size() > 0) ours.voltage_V[side] = other.voltage_V[side];
    if (other.power_W[side].size() > 0) ours.power_W[side] = other.power_W[side];
  }
  if (other.battery_power_W.size() > 0) ours.battery_power_W = other.battery_power_W;
  return ours;
}

SimulatorGap simulator_gap(const std::vector<RunSignals>& signals, const std::vector<OtherPrediction>& others,
                           double noise_floor_percent) {
  std::vector<RunEnergy> energies;
  for (std::size_t r = 0; r < signals.size(); ++r)
    if (const RunEnergy energy = energy_of(signals[r], others[r]); energy.measured_J != 0)
      energies.push_back(energy);
  return {.runs = energies.size(),
          .of_runs = signals.size(),
          .gap_percent = energy_gap_percent(energies),
          .bias_percent = energy_bias_percent(energies),
          .noise_floor_percent = noise_floor_percent};
}

Verdict verdict_with(const SimulatorGap& simulator) {
  if (simulator.runs == 0) return simulator.model_verdict;
  if (simulator.exceeds()) return Verdict::unexplained;
  return simulator.model_verdict == Verdict::too_little_data ? Verdict::too_little_data : Verdict::no_gap;
}

std::string told_by_others(const Dataset& dataset, const SimulatorGap& simulator) {
  const auto given =
      std::ranges::count_if(dataset.runs, [](const Run& run) { return run.predicted.has_value(); });
  if (given == 0) return {};
  if (simulator.runs == 0)
    return "another simulator's prediction and its log have no power of the same place: no energy gap of the "
           "simulator is known";
  return std::to_string(simulator.runs) + " of " + std::to_string(simulator.of_runs) +
         " runs have another simulator's prediction: the location of the gap refers to it; causes and shrink "
         "refer to this model";
}

}  // namespace joulepath
