#include "diagnosis/where/other_prediction.hpp"

#include <cmath>
#include <cstdio>

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
  return result;
}

/// Energy gap of the other simulator on the runs with its power.
struct OtherGap {
  std::size_t runs{};
  double gap_J{}, bias_J{}, measured_J{};
};

OtherGap gap_of(const std::vector<RunSignals>& signals, const std::vector<OtherPrediction>& others) {
  OtherGap gap;
  for (std::size_t r = 0; r < signals.size(); ++r) {
    if (!others[r].has_power()) continue;
    double run_J = 0, measured_J = 0;
    for (Side side : kSides) {
      const Eigen::VectorXd measured_W = measured_power_W(signals[r], side);
      if (measured_W.size() == 0) continue;
      run_J += signals[r].period_s * (others[r].power_W[side] - measured_W).sum();
      measured_J += signals[r].period_s * measured_W.sum();
    }
    ++gap.runs;
    gap.gap_J += std::abs(run_J), gap.bias_J += run_J, gap.measured_J += std::abs(measured_J);
  }
  return gap;
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
                 .power_W = std::move(read.motor_power_W)};
  }
  return others;
}

Prediction in_place_of(Prediction ours, const OtherPrediction& other) {
  for (Side side : kSides) {
    if (other.current_A[side].size() > 0) ours.current_A[side] = other.current_A[side];
    if (other.voltage_V[side].size() > 0) ours.voltage_V[side] = other.voltage_V[side];
    if (other.power_W[side].size() > 0) ours.power_W[side] = other.power_W[side];
  }
  return ours;
}

std::string told_by_others(const std::vector<RunSignals>& signals,
                           const std::vector<OtherPrediction>& others) {
  const OtherGap gap = gap_of(signals, others);
  if (gap.runs == 0 || gap.measured_J == 0) return {};
  char text[320];
  std::snprintf(text, sizeof text,
                "%zu of %zu runs have another simulator's prediction: the location of the gap refers to it "
                "(energy gap %.3g %%, bias %.3g %%); causes and shrink refer to this model",
                gap.runs, signals.size(), 100 * gap.gap_J / gap.measured_J,
                100 * gap.bias_J / gap.measured_J);
  return text;
}

}  // namespace joulepath
