#include "diagnosis/simulator/simulated_runs.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/numerics/smoothing.hpp"
#include "diagnosis/prediction/prediction.hpp"
#include "diagnosis/signals/velocity_filter.hpp"
#include "diagnosis/thresholds.hpp"
// Design: docs/decisions/0514-the-users-simulator.md
// Method: [Nelson1990]
namespace joulepath {
namespace {

using Series = std::vector<double>;

/// Of the run's payload as it changes, at the simulator's times.
Series payload_at(const Run& real, const Series& time_s) {
  if (real.log.payload_kg.empty()) return {};
  Series payload_kg;
  for (double t : time_s) {
    const auto after = std::ranges::upper_bound(real.log.time_s, t) - real.log.time_s.begin();
    payload_kg.push_back(
        real.log.payload_kg[static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, after) - 1)]);
  }
  return payload_kg;
}

/// The speeds of a log as a filter of the robot's would show them.
void smooth_speeds(double time_constant_s, Trajectory& log) {
  for (Series* speed : {&log.wheel_speed_rad_s.left, &log.wheel_speed_rad_s.right, &log.linear_speed_m_s,
                        &log.angular_speed_rad_s})
    *speed = behind_velocity_filter(std::move(*speed), log.time_s, time_constant_s);
}

/// Sharp speeds of a simulator are put behind the filter of the robot's: both motions are the filtered one.
Run simulated_run(const Run& real) {
  Run run = real;
  run.log = *real.predicted;
  if (real.predicted_filter_s > 0)
    run.velocity_filter_s = real.predicted_filter_s;
  else
    smooth_speeds(real.velocity_filter_s, run.log);
  run.log.payload_kg = payload_at(real, run.log.time_s);
  run.predicted.reset();
  run.current_sign_from_motion = false;
  return run;
}

/// Measured less predicted, where it is measured.
Series difference(const Eigen::VectorXd& measured, const Eigen::VectorXd& predicted) {
  if (measured.size() == 0 || measured.size() != predicted.size()) return {};
  const Eigen::VectorXd beyond = measured - predicted;
  return {beyond.begin(), beyond.end()};
}

Series flags(const std::vector<bool>& of) { return {of.begin(), of.end()}; }

/// What a pose has beyond the wheels', turned from the simulator's frame into the robot's.
void add_pose(const RunSignals& simulated, const Prediction& model, double turn_rad,
              DeviationOf<Series>& of) {
  if (simulated.heading_measured) of.heading_rad = difference(simulated.heading_rad, model.heading_rad);
  of.x_m = difference(simulated.x_m, model.x_m);
  of.y_m = difference(simulated.y_m, model.y_m);
  if (of.y_m.empty()) of.x_m.clear();
  for (std::size_t i = 0; i < of.x_m.size(); ++i) {
    const double x = of.x_m[i] - of.x_m.front(), y = of.y_m[i] - of.y_m.front();
    of.x_m[i] = std::cos(turn_rad) * x - std::sin(turn_rad) * y;
    of.y_m[i] = std::sin(turn_rad) * x + std::cos(turn_rad) * y;
  }
  if (!of.x_m.empty()) of.x_m.front() = of.y_m.front() = 0.0;
}

DeviationOf<Series> deviation_of(const RunSignals& simulated, const Prediction& model, double turn_rad) {
  DeviationOf<Series> of{.battery_power_W = difference(simulated.battery_power_W, model.battery_power_W),
                         .yaw_rate_rad_s = difference(simulated.gyro_yaw_rate_rad_s, model.yaw_rate_rad_s)};
  if (simulated.battery_current_A.size() > 0)
    of.battery_voltage_V = difference(simulated.battery_voltage_V, model.battery_voltage_V);
  for (Side side : kSides) {
    of.current_A[side] = difference(simulated.motor_current_A[side], model.current_A[side]);
    of.voltage_V[side] = difference(simulated.motor_voltage_V[side], model.voltage_V[side]);
    of.power_W[side] = difference(simulated.motor_power_W[side], model.power_W[side]);
    of.turning[side] = flags(simulated.turning[side]);
  }
  add_pose(simulated, model, turn_rad, of);
  return of;
}

void refuse_other_motion(const Run& run, const Alignment& alignment) {
  if (alignment.motion_difference <= kOtherMotion) return;
  throw ConfigError({run.mark, "predicted",
                     "wheel speeds that differ from those of " + run.name + " by " +
                         std::to_string(std::lround(100 * alignment.motion_difference)) + " % (rms)",
                     "the simulator's log of the same run",
                     "aligned by time, by commands and by path; the simulator must drive the same commands"});
}

/// Names of the channels that a run's log has and its prediction lacks.
void add_lacking(const RunSignals& real, const DeviationOf<Series>& of, std::vector<std::string>& lacking) {
  const auto note = [&](const char* name, bool measured, const Series& predicted) {
    if (measured && predicted.empty() && std::ranges::count(lacking, name) == 0) lacking.push_back(name);
  };
  note("motor current", real.motor_current_A.left.size() > 0, of.current_A.left);
  note("motor voltage", real.motor_voltage_V.left.size() > 0, of.voltage_V.left);
  note("battery power", real.battery_power_W.size() > 0, of.battery_power_W);
  note("gyro", real.gyro_yaw_rate_rad_s.size() > 0, of.yaw_rate_rad_s);
  note("position", real.x_m.size() > 0, of.x_m);
}

}  // namespace

bool has_prediction(const Run& run) { return run.predicted && has_usable_log(run); }

Dataset simulator_dataset(const Dataset& dataset) {
  Dataset simulators = dataset;
  simulators.artifacts.clear();
  simulators.runs.clear();
  for (const Run& run : dataset.runs)
    if (has_prediction(run)) simulators.runs.push_back(simulated_run(run));
  return simulators;
}

ComparedRuns compare_runs(const Dataset& dataset, const Robot& robot) {
  ComparedRuns compared{.dataset = dataset};
  compared.dataset.robot = robot;
  compared.dataset.runs.clear();
  for (std::size_t r = 0; r < dataset.runs.size(); ++r) {
    if (!has_prediction(dataset.runs[r])) continue;
    Run& run = compared.dataset.runs.emplace_back(dataset.runs[r]);
    const Run simulated = simulated_run(run);
    if (!has_usable_log(simulated))
      throw ConfigError({run.mark, "predicted",
                         "a log of " + std::to_string(simulated.log.size()) + " samples",
                         "a motion of at least 40 samples and 0.5 s", ""});
    const RunSignals here = make_run_signals(run, r, robot), there = make_run_signals(simulated, r, robot);
    Alignment alignment = align(run, here, simulated, there);
    refuse_other_motion(run, alignment);
    const double turn_rad = here.heading_rad[0] - there.heading_rad[0];
    run.deviation = {alignment.real_time_s, deviation_of(there, predict(there, {.robot = robot}), turn_rad)};
    add_lacking(here, run.deviation->of, compared.lacking);
    compared.alignments.push_back(std::move(alignment));
    compared.indices.push_back(r);
  }
  return compared;
}

}  // namespace joulepath
