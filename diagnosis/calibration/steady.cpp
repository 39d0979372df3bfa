#include "diagnosis/calibration/steady.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "diagnosis/calibration/resampling.hpp"
#include "diagnosis/calibration/written_errors.hpp"
#include "diagnosis/estimation/model_energy.hpp"
#include "model/nuisance_correlation.hpp"

namespace joulepath::calibration {
namespace {

constexpr double kShortest_s = 1.0, kStraight = 0.05, kLeastAcceleration_rad_s2 = 0.1, kNoiseFactor = 5;

bool is_steady(const SmoothedSample& sample, double threshold_rad_s2) {
  const Sided<double>& q = sample.speed_rad_s;
  return sample.turning.left && sample.turning.right &&
         std::abs(sample.acceleration_rad_s2.left) < threshold_rad_s2 &&
         std::abs(sample.acceleration_rad_s2.right) < threshold_rad_s2 &&
         std::abs(q.right - q.left) < kStraight * std::abs(q.right + q.left);
}

SteadySegment mean_of(const SmoothedRun& run, std::size_t first, std::size_t last) {
  SteadySegment segment{.run = run.name,
                        .start_s = run.samples[first].time_s,
                        .duration_s = run.samples[last - 1].time_s - run.samples[first].time_s};
  const double share = 1 / static_cast<double>(last - first);
  for (std::size_t i = first; i < last; ++i)
    for (Side side : kSides) {
      segment.speed_rad_s[side] += share * run.samples[i].speed_rad_s[side];
      segment.current_A[side] += share * run.samples[i].current_A[side];
      segment.voltage_V[side] += share * run.samples[i].voltage_V[side];
    }
  return segment;
}

/// y = first sign(q) + second q by weighted least squares.
std::array<double, 2> line(const std::vector<SteadySegment>& segments, Side side,
                           const Sided<double> SteadySegment::*channel) {
  double ss = 0, sq = 0, qq = 0, sy = 0, qy = 0;
  for (const SteadySegment& segment : segments) {
    const double y = (segment.*channel)[side];
    if (!std::isfinite(y)) continue;
    const double w = segment.duration_s, q = segment.speed_rad_s[side], s = q > 0 ? 1.0 : -1.0;
    ss += w, sq += w * s * q, qq += w * q * q, sy += w * s * y, qy += w * q * y;
  }
  const double determinant = ss * qq - sq * sq;
  return {(qq * sy - sq * qy) / determinant, (ss * qy - sq * sy) / determinant};
}

/// Lowest and highest |speed| of the segments.
std::array<double, 2> speed_range_rad_s(const std::vector<SteadySegment>& segments) {
  std::array<double, 2> range{1e300, 0};
  for (const SteadySegment& segment : segments) {
    const double speed = 0.5 * std::abs(segment.speed_rad_s.left + segment.speed_rad_s.right);
    range = {std::min(range[0], speed), std::max(range[1], speed)};
  }
  return range;
}

std::vector<double> torques_Nm(const Robot& robot, const std::vector<SteadySegment>& segments) {
  std::vector<double> values;
  for (Side side : kSides) {
    const SteadyLine fit = fit_steady_line(segments, side);
    const double K = robot.motor[side].torque_per_ampere_Nm_A();
    values.push_back(fit.b1_A * K), values.push_back(fit.b2_A_s_rad * K);
  }
  return values;
}

double current_rms_A(const Robot& robot, const std::vector<SteadySegment>& segments) {
  double squares = 0, weight = 0;
  for (const SteadySegment& segment : segments)
    for (Side side : kSides) {
      const Motor& motor = robot.motor[side];
      const double q = segment.speed_rad_s[side];
      const double torque_Nm =
          (q > 0 ? 1 : -1) * motor.friction_torque_Nm + motor.viscous_friction_Nm_s_rad * q;
      squares += segment.duration_s *
                 std::pow(segment.current_A[side] - torque_Nm / motor.torque_per_ampere_Nm_A(), 2);
      weight += segment.duration_s;
    }
  return std::sqrt(squares / weight);
}

void require_usable(const Dataset& dataset, const std::vector<SteadySegment>& segments) {
  if (segments.empty())
    throw ConfigError({.mark = {.file = dataset.file},
                       .key = "runs",
                       .found = "no stretch of constant speed on a straight line of 1 s or more",
                       .accepted = "runs at constant speeds",
                       .hint = "the full method (--method full) uses accelerated runs too"});
  const auto [slowest, fastest] = speed_range_rad_s(segments);
  if (fastest < 1.2 * slowest)
    throw ConfigError({.mark = {.file = dataset.file},
                       .key = "runs",
                       .found = "steady stretches at one speed alone (" + std::to_string(slowest) + " to " +
                                std::to_string(fastest) + " rad/s at the wheel)",
                       .accepted = "at least two speeds, the faster 1.2 times the slower",
                       .hint = "one speed cannot separate Coulomb from viscous friction"});
}

constexpr const char* kParameterNames[] = {"friction_torque_left_Nm", "viscous_friction_left_Nm_s_rad",
                                           "friction_torque_right_Nm", "viscous_friction_right_Nm_s_rad"};

bool is_coulomb(std::size_t k) { return k % 2 == 0; }
Side side_of(std::size_t k) { return k < 2 ? Side::left : Side::right; }

/// What is left out in turn: whole runs, or steady segments where there are too few runs.
struct Units {
  std::vector<std::string> runs{};
  bool by_run{};
  std::size_t count{};
};

Units units_of(const std::vector<SteadySegment>& segments) {
  std::set<std::string> names;
  for (const SteadySegment& segment : segments) names.insert(segment.run);
  Units units{.runs = {names.begin(), names.end()}, .by_run = names.size() >= kFewestUnits};
  units.count = units.by_run ? units.runs.size() : segments.size();
  return units;
}

std::vector<double> torques_without(const Robot& robot, const std::vector<SteadySegment>& segments,
                                    const Units& units, std::size_t left_out) {
  std::vector<SteadySegment> rest;
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (units.by_run ? segments[i].run != units.runs[left_out] : i != left_out) rest.push_back(segments[i]);
  return torques_Nm(robot, rest);
}

/// T_m and nu are proportional to the robot file's Kt and inherit its relative error.
FittedErrors errors_of(const Robot& robot, const std::vector<SteadySegment>& segments, const Units& units,
                       const std::vector<double>& values) {
  if (units.count < kFewestUnits) return {.deviation = std::vector<double>(values.size(), std::nan(""))};
  const Resampled runs = jackknife(
      units.count, [&](std::size_t left_out) { return torques_without(robot, segments, units, left_out); });
  const std::string constant = "torque_constant_Nm_A";
  const bool is_stated = may_correlate(robot, constant);
  Eigen::MatrixXd changes(std::ssize(values), is_stated ? 1 : 0);
  if (is_stated)
    changes.col(0) = robot.uncertainty.at(constant) * Eigen::VectorXd::Map(values.data(), std::ssize(values));
  return with_inherited(robot, runs.covariance, changes,
                        is_stated ? std::vector{constant} : std::vector<std::string>{});
}

CalibratedParameter parameter_of(const Motor& motor, std::size_t k, double value, double deviation,
                                 double units) {
  CalibratedParameter parameter{
      .name = kParameterNames[k],
      .unit = is_coulomb(k) ? "N m" : "N m s/rad",
      .nominal = is_coulomb(k) ? motor.friction_torque_Nm : motor.viscous_friction_Nm_s_rad,
      .value = value,
      .standard_deviation = deviation,
      .effective_runs = units};
  state_interval(parameter);
  if (value < 0) {
    parameter.note = "the fit is negative: the robot file keeps its value";
    parameter.visibility = Visibility::weak;
  }
  return parameter;
}

/// Values that are not negative.
void write_to(Robot& robot, const std::vector<double>& values) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (values[k] < 0) continue;
    Motor& motor = robot.motor[side_of(k)];
    (is_coulomb(k) ? motor.friction_torque_Nm : motor.viscous_friction_Nm_s_rad) = values[k];
  }
}

/// The runs with a robot that the others give; none where too few have steady segments.
std::vector<HeldOutRun> held_out_steady_runs(const Dataset& dataset,
                                             const std::vector<SteadySegment>& segments, const Units& units) {
  std::vector<HeldOutRun> held_out;
  for (std::size_t k = 0; k < units.runs.size() && units.by_run; ++k) {
    Robot robot = dataset.robot;
    write_to(robot, torques_without(robot, segments, units, k));
    for (const Run& run : dataset.runs)
      if (run.name == units.runs[k]) held_out.push_back({run, robot});
  }
  return held_out;
}

}  // namespace

std::vector<SteadySegment> find_steady_segments(const std::vector<SmoothedRun>& runs) {
  std::vector<SteadySegment> segments;
  for (const SmoothedRun& run : runs) {
    const double threshold = std::max(kLeastAcceleration_rad_s2, kNoiseFactor * run.speed_noise_rad_s *
                                                                     std::sqrt(run.kernel.derivative_gain));
    std::size_t first = 0;
    for (std::size_t i = 0; i <= run.samples.size(); ++i) {
      const bool goes_on = i < run.samples.size() && is_steady(run.samples[i], threshold) &&
                           (i == first || run.samples[i].time_s - run.samples[i - 1].time_s < 0.5);
      if (goes_on) continue;
      if (i > first + 1 && run.samples[i - 1].time_s - run.samples[first].time_s >= kShortest_s)
        segments.push_back(mean_of(run, first, i));
      first = i < run.samples.size() && is_steady(run.samples[i], threshold) ? i : i + 1;
    }
  }
  return segments;
}

SteadyLine fit_steady_line(const std::vector<SteadySegment>& segments, Side side) {
  const auto [b1, b2] = line(segments, side, &SteadySegment::current_A);
  SteadyLine fit{.b1_A = b1, .b2_A_s_rad = b2};
  fit.has_voltage = std::any_of(segments.begin(), segments.end(), [&](const SteadySegment& segment) {
    return std::isfinite(segment.voltage_V[side]);
  });
  if (fit.has_voltage) {
    const auto [c1, c2] = line(segments, side, &SteadySegment::voltage_V);
    fit.c1_V = c1, fit.c2_V_s_rad = c2;
  }
  return fit;
}

CalibrationResult calibrate_steady(const Dataset& dataset, const std::vector<SmoothedRun>& runs) {
  CalibrationResult result{.method = CalibrationMethod::steady, .robot = dataset.robot};
  result.segments = find_steady_segments(runs);
  require_usable(dataset, result.segments);
  result.lines = Sided<SteadyLine>{fit_steady_line(result.segments, Side::left),
                                   fit_steady_line(result.segments, Side::right)};
  const Units units = units_of(result.segments);
  result.runs_used = units.runs.size(), result.samples_used = result.segments.size();
  result.resampled = units.by_run ? "runs" : "steady segments";
  if (units.count < kFewestUnits)
    result.notes.push_back("fewer than " + std::to_string(kFewestUnits) + " steady segments: no intervals");
  const std::vector<double> values = torques_Nm(dataset.robot, result.segments);
  const FittedErrors errors = errors_of(dataset.robot, result.segments, units, values);
  for (std::size_t k = 0; k < values.size(); ++k)
    result.parameters.push_back(parameter_of(dataset.robot.motor[side_of(k)], k, values[k],
                                             errors.deviation[k], static_cast<double>(units.count)));
  result.current_rms_before_A = current_rms_A(result.robot, result.segments);
  write_to(result.robot, values);
  write_errors(result.parameters, {{"friction_torque_Nm", {0, 2}}, {"viscous_friction_Nm_s_rad", {1, 3}}},
               errors, result.robot);
  result.current_rms_after_A = current_rms_A(result.robot, result.segments);
  result.notes.push_back(
      write_model_energy(held_out_steady_runs(dataset, result.segments, units), result.robot));
  result.notes.push_back("constant speeds do not show inertias; R and Kt n are the robot file's");
  return result;
}

}  // namespace joulepath::calibration
