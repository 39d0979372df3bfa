#include "diagnosis/energies_only/energy_run.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnosis/thresholds.hpp"
#include "model/motions.hpp"
#include "model/power.hpp"
#include "model/watt_hours.hpp"

namespace joulepath {
namespace {

constexpr double kStep_s = 0.02;
constexpr double kLeastStep_s = 1e-6;

PrescribedMotion doubted(PrescribedMotion motion, MotionDoubt doubt, double factor) {
  if (doubt == MotionDoubt::start_speed) {
    if (motion.start_speed_m_s) *motion.start_speed_m_s *= factor;
    return motion;
  }
  const std::optional<double> braking =
      motion.deceleration_m_s2 ? motion.deceleration_m_s2 : motion.acceleration_m_s2;
  if (braking) motion.deceleration_m_s2 = *braking * factor;
  return motion;
}

double payload_at(const std::vector<PayloadStep>& steps, double time_s) {
  double payload_kg = steps.empty() ? 0.0 : steps.front().payload_kg;
  for (const PayloadStep& step : steps)
    if (time_s >= step.from_s) payload_kg = step.payload_kg;
  return payload_kg;
}

/// Indices of samples at distinct times: ramps may join at the same instant.
std::vector<std::size_t> apart(const std::vector<double>& time_s) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < time_s.size(); ++i)
    if (kept.empty() || time_s[i] - time_s[kept.back()] > kLeastStep_s) kept.push_back(i);
  return kept;
}

Eigen::VectorXd picked(const std::vector<double>& values, const std::vector<std::size_t>& which) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(which.size()));
  for (std::size_t i = 0; i < which.size(); ++i) result[static_cast<Eigen::Index>(i)] = values[which[i]];
  return result;
}

Eigen::VectorXd steps(const Eigen::VectorXd& values) {
  return values.tail(values.size() - 1) - values.head(values.size() - 1);
}

Eigen::VectorXd middles(const Eigen::VectorXd& values) {
  return 0.5 * (values.tail(values.size() - 1) + values.head(values.size() - 1));
}

/// Speeds are linear between the samples of a prescribed motion, so midpoints and slopes are exact.
DrivenMotion driven(const Run& run, const PrescribedMotion& motion, const Robot& robot) {
  const Trajectory log = timed_motion(robot, {motion}, {.sample_period_s = kStep_s}).trajectory;
  DrivenMotion result{.signals = {.name = run.name, .period_s = kStep_s, .log_period_s = kStep_s}};
  RunSignals& signals = result.signals;
  const std::vector<std::size_t> samples = apart(log.time_s);
  const Eigen::VectorXd time_s = picked(log.time_s, samples);
  result.step_s = steps(time_s);
  const Eigen::Index n = result.step_s.size();
  signals.time_s = middles(time_s);
  signals.time_of_day_known = run.start_time_s.has_value();
  signals.time_of_day_s = signals.time_s.array() + run.start_time_s.value_or(0.0);
  signals.payload_kg.resize(n);
  for (Eigen::Index j = 0; j < n; ++j) signals.payload_kg[j] = payload_at(run.payload, signals.time_s[j]);
  for (Side side : kSides) {
    const Eigen::VectorXd speed = picked(log.wheel_speed_rad_s[side], samples);
    signals.wheel_speed_rad_s[side] = middles(speed);
    signals.wheel_acceleration_rad_s2[side] = steps(speed).cwiseQuotient(result.step_s);
    signals.wheel_angle_rad[side] = signals.wheel_along_x_rad[side] = signals.wheel_along_y_rad[side] =
        Eigen::VectorXd::Zero(n);
  }
  signals.heading_rad = middles(picked(log.heading_rad, samples));
  return result;
}

/// The motion with one doubt applied; the prescribed motion where it cannot be driven so (no room to brake).
DrivenMotion driven_otherwise(const Run& run, MotionDoubt doubt, double factor, const Robot& robot,
                              const DrivenMotion& as_prescribed) {
  try {
    return driven(run, doubted(*run.motion, doubt, factor), robot);
  } catch (const ConfigError&) {
    return as_prescribed;
  }
}

std::string path_kind(const PrescribedMotion& motion, const DrivenMotion& driven) {
  if (motion.profile == MotionProfile::stand) return "standstill";
  if (motion.profile == MotionProfile::spin) return "spin";
  const Eigen::VectorXd& heading = driven.signals.heading_rad;
  const double turned = heading.size() > 0 ? heading[heading.size() - 1] - heading[0] : 0.0;
  if (std::abs(turned) < kStraight_rad) return motion.bezier_m.empty() ? "straight" : "curve";
  return turned > 0 ? "curve to the left" : "curve to the right";
}

EnergyRun energy_run(const Run& run, std::size_t index, const Robot& robot) {
  EnergyRun result{.run_index = index, .name = run.name, .motion = driven(run, *run.motion, robot)};
  for (std::size_t k = 0; k < kMotionDoubts.size(); ++k)
    for (int more : {0, 1})
      result.doubted[k][static_cast<std::size_t>(more)] = driven_otherwise(
          run, kMotionDoubts[k], 1 + (more ? 1 : -1) * kMotionDoubtSigma, robot, result.motion);
  result.wheel_J = run.measured_energy_J;
  if (run.battery_energy_Wh) result.battery_J = *run.battery_energy_Wh * kJoulesPerWh;
  result.payload_kg = run.payload.empty() ? 0.0 : run.payload.front().payload_kg;
  result.acceleration_m_s2 = run.motion->acceleration_m_s2.value_or(0.0);
  result.path = path_kind(*run.motion, result.motion);
  return result;
}

}  // namespace

std::vector<EnergyRun> energy_runs(const Dataset& dataset) {
  std::vector<EnergyRun> runs;
  for (std::size_t r = 0; r < dataset.runs.size(); ++r) {
    const Run& run = dataset.runs[r];
    if (!is_energy_run(run)) continue;
    try {
      runs.push_back(energy_run(run, r, dataset.robot));
    } catch (const ConfigError& error) {
      ConfigError::Detail detail = error.detail();
      if (detail.mark.file.empty()) detail.mark = run.mark, detail.key = run.name + "." + detail.key;
      throw ConfigError(detail);
    }
  }
  return runs;
}

RunJoules joules_of(const DrivenMotion& motion, const ModelPoint& point) {
  const Prediction p = predict(motion.signals, point);
  PowerSupply supply = make_plant(point.robot, point.effects).robot.power;
  supply.sharing = PowerSharing::wheel;  // each wheel regenerates separately
  RunJoules joules{.wheel_J = {}, .battery_J = p.battery_power_W.dot(motion.step_s)};
  for (Eigen::Index j = 0; j < motion.step_s.size(); ++j) {
    joules.wheel_J.left += motion.step_s[j] * supply_power_W(supply, {p.power_W.left[j], 0.0});
    joules.wheel_J.right += motion.step_s[j] * supply_power_W(supply, {0.0, p.power_W.right[j]});
  }
  return joules;
}

Eigen::VectorXd energy_rows(const EnergyRun& run, const RunJoules& joules) {
  if (!run.wheel_J) return Eigen::VectorXd::Constant(1, joules.battery_J);
  return Eigen::Vector2d(joules.wheel_J.left + joules.wheel_J.right,
                         joules.wheel_J.right - joules.wheel_J.left);
}

Eigen::VectorXd measured_rows(const EnergyRun& run) {
  return energy_rows(
      run, {.wheel_J = run.wheel_J.value_or(Sided<double>{}), .battery_J = run.battery_J.value_or(0.0)});
}

}  // namespace joulepath
