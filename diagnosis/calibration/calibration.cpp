#include "diagnosis/calibration/calibration.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "diagnosis/calibration/calibrated_robot.hpp"
#include "diagnosis/calibration/identifiability.hpp"
#include "diagnosis/calibration/resampling.hpp"
#include "diagnosis/calibration/steady.hpp"
#include "diagnosis/calibration/written_errors.hpp"
#include "diagnosis/estimation/model_energy.hpp"
#include "model/model_error.hpp"
#include "model/nuisance_correlation.hpp"
#include "model/student_t.hpp"

namespace joulepath {
namespace {

using namespace calibration;

constexpr std::size_t kFewestRuns = 6;  ///< fewer are cut into blocks
constexpr int kBlock_s = 10;
constexpr int kDerived = 2;  ///< wheel axle and chassis yaw inertia, listed after the fitted values

[[noreturn]] void refuse(const Dataset& dataset, std::string found, std::string accepted, std::string hint) {
  throw ConfigError({.mark = {.file = dataset.file},
                     .key = "runs",
                     .found = std::move(found),
                     .accepted = std::move(accepted),
                     .hint = std::move(hint)});
}

/// Throws the error that names the channels that every run lacks.
[[noreturn]] void refuse_channels(const Dataset& dataset) {
  bool speeds = false, currents = false, logs = false;
  for (const Run& run : dataset.runs) {
    logs = logs || run.log.size() > 0;
    speeds = speeds || !run.log.wheel_speed_rad_s.left.empty() || !run.log.linear_speed_m_s.empty();
    currents = currents || (!run.log.motor_current_A.left.empty() && !run.log.motor_current_A.right.empty());
  }
  const std::string accepted = "logs with wheel_speed_left/right_rad_s and motor_current_left/right_A";
  if (!logs) refuse(dataset, "no run with a log", accepted, "an energy-only run cannot calibrate a model");
  if (!currents)
    refuse(dataset, "no run with motor currents", accepted,
           "currents measure the torques; map the columns if they have other names");
  if (!speeds)
    refuse(dataset, "no run with wheel speeds", accepted,
           "linear_speed_m_s and angular_speed_rad_s are sufficient");
  refuse(dataset, "no run has both wheel speeds and motor currents over 20 samples", accepted, {});
}

/// Lower bounds: J is at least the part that the masses of the robot file make up.
FitValues lower_bounds(const Robot& robot) {
  FitValues lower{};
  const double r = 0.5 * (robot.geometry.wheel_radius_m.left + robot.geometry.wheel_radius_m.right);
  lower[kStraightInertia] = robot.total_mass_kg(0.0) * r * r / 2;
  lower[kPayloadFactor] = 0.5;
  const FitValues nominal = nominal_values(robot);
  lower[kTorquePerAmpere] = 1e-3 * nominal[kTorquePerAmpere];
  lower[kResistance] = 1e-3 * nominal[kResistance];
  return lower;
}

/// Bounds for resampling: a bound would hide the scatter of the estimates.
FitValues without_bounds(FitValues lower) {
  for (int p : {kFrictionLeft, kFrictionRight, kViscous, kStraightInertia, kTurningInertia})
    lower[static_cast<std::size_t>(p)] = -1e6;
  return lower;
}

std::vector<int> indices_of(const FreeParameters& free) {
  std::vector<int> index;
  for (int p = 0; p < kFitParameters; ++p)
    if (free[static_cast<std::size_t>(p)]) index.push_back(p);
  return index;
}

/// Effective number of units for each parameter: (sum h)^2 / sum h^2, where h is a unit's part of the
/// information.
std::array<double, kFitParameters> effective_units(const std::vector<FitSums>& units, const FitSums& all,
                                                   const FitWeights& weights, const FitValues& values,
                                                   const FreeParameters& free) {
  const std::vector<int> index = indices_of(free);
  const Eigen::MatrixXd inverse = information(all, weights, values)(index, index).inverse();
  std::array<double, kFitParameters> sum{}, squares{}, count{};
  for (const FitSums& unit : units) {
    const Eigen::MatrixXd part = inverse * information(unit, weights, values)(index, index) * inverse;
    for (std::size_t i = 0; i < index.size(); ++i) {
      const double h = part(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i));
      sum[static_cast<std::size_t>(index[i])] += h, squares[static_cast<std::size_t>(index[i])] += h * h;
    }
  }
  for (std::size_t p = 0; p < count.size(); ++p) count[p] = squares[p] > 0 ? sum[p] * sum[p] / squares[p] : 0;
  return count;
}

/// The fitted parameter from which a reported value is derived.
std::size_t source_of(std::size_t p) {
  if (p < kFitParameters) return p;
  return p == kFitParameters ? std::size_t{kStraightInertia} : std::size_t{kTurningInertia};
}

std::vector<double> reported(const Robot& robot, const FitValues& values) {
  std::vector<double> all(values.begin(), values.end());
  const DerivedInertia inertia = derived_inertia(robot, values);
  all.push_back(inertia.wheel_axle_kg_m2), all.push_back(inertia.chassis_yaw_kg_m2);
  return all;
}

/// Correction of the jackknife, which weighs runs with a large share of a parameter's information too
/// heavily, by about 1/(1 - share). The result is the mean of that factor for the effective number of runs;
/// it is 1 for equal runs.
double leverage_correction(double effective, std::size_t units) {
  const auto n = static_cast<double>(units);
  return std::sqrt(std::max(0.0, 1 - 1 / std::max(effective, 1.5)) * n / (n - 1));
}

CalibratedParameter parameter_of(std::size_t p, double nominal, double value, double deviation,
                                 double effective) {
  constexpr const char* kUnits[] = {"N m", "N m", "N m s/rad", "kg m^2", "kg m^2", "", "N m/A", "ohm"};
  CalibratedParameter parameter{.name = p < kFitParameters    ? fit_parameter_name(static_cast<int>(p))
                                        : p == kFitParameters ? "wheel_axle_inertia_kg_m2"
                                                              : "chassis_yaw_inertia_kg_m2",
                                .unit = p < kFitParameters ? kUnits[p] : "kg m^2",
                                .nominal = nominal,
                                .value = value,
                                .standard_deviation = deviation,
                                .effective_runs = effective};
  state_interval(parameter);
  return parameter;
}

/// Keys of the robot file and the reported values that they hold.
std::vector<WrittenKey> written_keys() {
  constexpr std::size_t kAxle = kFitParameters, kYaw = kFitParameters + 1;
  return {{"friction_torque_Nm", {kFrictionLeft, kFrictionRight}},
          {"viscous_friction_Nm_s_rad", {kViscous, kViscous}},
          {"resistance_ohm", {kResistance, kResistance}},
          {"torque_constant_Nm_A", {kTorquePerAmpere, kTorquePerAmpere}},
          {"wheel_axle_inertia_kg_m2", {kAxle, kAxle}},
          {"chassis_yaw_inertia_kg_m2", {kYaw, kYaw}}};
}

void hold(CalibratedParameter& parameter, const std::string& why) {
  parameter.value = parameter.nominal;
  parameter.effective_runs = 0;
  parameter.standard_deviation = std::nan("");
  parameter.interval_95.fill(parameter.standard_deviation);
  parameter.visibility = Visibility::unseen;
  parameter.note = why;
}

struct Fit {
  FitSums all{};
  FitWeights weights{};
  FitResult result{};
  Identifiability can{};
};

std::string blocks_text() { return "blocks of " + std::to_string(kBlock_s) + " s"; }

/// Derivatives of the reported values, which are linear in the fitted ones.
Eigen::MatrixXd reported_by_fitted(const Robot& robot, const FitValues& values) {
  const auto vector_of = [&](const FitValues& at) {
    const std::vector<double> all = reported(robot, at);
    return Eigen::VectorXd(Eigen::VectorXd::Map(all.data(), std::ssize(all)));
  };
  const Eigen::VectorXd here = vector_of(values);
  Eigen::MatrixXd slopes(here.size(), kFitParameters);
  for (int p = 0; p < kFitParameters; ++p) {
    FitValues moved = values;
    moved[static_cast<std::size_t>(p)] += 1;
    slopes.col(p) = vector_of(moved) - here;
  }
  return slopes;
}

/// Covariance of the reported values for independent residuals; zero for what is not fitted.
Eigen::MatrixXd covariance_of_samples(const Robot& robot, const Fit& fit) {
  const std::vector<int> index = indices_of(fit.can.free);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(kFitParameters, kFitParameters);
  const Eigen::MatrixXd free = information(fit.all, fit.weights, fit.result.values)(index, index);
  covariance(index, index) = Eigen::MatrixXd(free.inverse());
  const Eigen::MatrixXd slopes = reported_by_fitted(robot, fit.result.values);
  return slopes * covariance * slopes.transpose();
}

/// Correlation of the reported values from how runs differ. A few runs do not determine it: that of the
/// samples' residuals counts as much as one run per parameter, so the matrix has full rank.
Eigen::MatrixXd correlation_of_runs(const Robot& robot, const Fit& fit, const Resampled& runs,
                                    std::size_t units) {
  const auto n = static_cast<double>(units), p = static_cast<double>(indices_of(fit.can.free).size());
  return (n * correlation_of(runs.covariance) + p * correlation_of(covariance_of_samples(robot, fit))) /
         (n + p);
}

/// Errors of the reported values: a jackknife over the units, NaN from too few, with the errors of the
/// robot's masses and lengths.
FittedErrors errors_of(const Robot& robot, const std::vector<FitSums>& units, const Fit& fit,
                       const FitValues& unbounded, const std::array<double, kFitParameters>& effective) {
  constexpr std::size_t kReported = kFitParameters + kDerived;
  if (units.size() < kFewestUnits) return {.deviation = std::vector<double>(kReported, std::nan(""))};
  const Resampled runs = jackknife(units.size(), [&](std::size_t left_out) {
    FitSums rest = fit.all;
    rest -= units[left_out];
    return reported(robot,
                    fit_full(rest, fit.weights, nominal_values(robot), unbounded, fit.can.free).values);
  });
  Eigen::VectorXd deviation(kReported);
  for (std::size_t p = 0; p < kReported; ++p)
    deviation[static_cast<Eigen::Index>(p)] =
        runs.standard_deviation[p] * leverage_correction(effective[source_of(p)], units.size());
  const std::vector<InheritedError> inherited = inherited_errors(robot, fit.result.values);
  Eigen::MatrixXd changes = Eigen::MatrixXd::Zero(kReported, std::ssize(inherited));
  std::vector<std::string> keys;
  for (const InheritedError& error : inherited) {
    changes.block<kDerived, 1>(kFitParameters, std::ssize(keys)) << error.change.wheel_axle_kg_m2,
        error.change.chassis_yaw_kg_m2;
    keys.push_back(error.key);
  }
  return with_inherited(
      robot,
      deviation.asDiagonal() * correlation_of_runs(robot, fit, runs, units.size()) * deviation.asDiagonal(),
      changes, std::move(keys));
}

/// A value at its lower bound: the interval is that of the fit without bounds, cut off at the bound.
void state_bound(CalibratedParameter& parameter, double unbounded_value, double least, const char* note) {
  parameter.visibility = Visibility::weak;
  const double moved = unbounded_value - parameter.value;
  for (double& end : parameter.interval_95) end = std::max(least, end + moved);
  parameter.note = note;
}

void state_derivation(CalibratedParameter& parameter, bool of_wheels) {
  parameter.note = of_wheels ? "with the robot file's masses and wheel radius"
                             : "with the robot file's masses, wheel radius and half track";
  if (parameter.value < 0) hold(parameter, "negative with the robot file's masses and lengths");
}

FittedErrors add_parameters(const Dataset& dataset, const std::vector<FitSums>& units, const Fit& fit,
                            const FitValues& lower, CalibrationResult& result) {
  const Robot& robot = dataset.robot;
  const FitValues nominal = nominal_values(robot);
  const FitValues unbounded = without_bounds(lower);
  if (units.size() < kFewestUnits)
    result.notes.push_back("fewer than " + std::to_string(kFewestUnits) + " runs or " + blocks_text() +
                           ": no intervals");
  const auto effective = effective_units(units, fit.all, fit.weights, fit.result.values, fit.can.free);
  FittedErrors errors = errors_of(robot, units, fit, unbounded, effective);
  const std::vector<double> center =
      reported(robot, fit_full(fit.all, fit.weights, nominal, unbounded, fit.can.free).values);
  const std::vector<double> before = reported(robot, nominal), after = reported(robot, fit.result.values);
  for (std::size_t p = 0; p < after.size(); ++p) {
    const std::size_t source = source_of(p);
    CalibratedParameter parameter =
        parameter_of(p, before[p], after[p], errors.deviation[p], effective[source]);
    if (!fit.can.free[source])
      hold(parameter, fit.can.why[source]);
    else if (fit.result.at_bound[source])
      state_bound(parameter, center[p], p < kFitParameters ? lower[p] : 0.0,
                  source == kStraightInertia ? "the robot file's masses alone exceed the value in the data"
                                             : "at its lower bound");
    else if (p >= kFitParameters)
      state_derivation(parameter, p == kFitParameters);
    result.parameters.push_back(parameter);
  }
  return errors;
}

/// The robot that all runs but one give, whose sums these are.
Robot robot_without(const Robot& robot, const Fit& fit, const FitValues& lower,
                    const std::vector<FitSums>& of_run) {
  FitSums rest = fit.all;
  for (const FitSums& sums : of_run) rest -= sums;
  return robot_with(robot, fit_full(rest, fit.weights, nominal_values(robot), lower, fit.can.free).values);
}

/// Each run with the robot that the others give; without one where there are too few to state an error.
std::vector<HeldOutRun> held_out_runs(const Dataset& dataset, const std::vector<SmoothedRun>& runs,
                                      const Fit& fit, const FitValues& lower) {
  std::vector<HeldOutRun> held_out;
  for (const SmoothedRun& run : runs) {
    held_out.push_back({dataset.runs[run.index], dataset.robot});
    if (runs.size() >= kLeastHeldOutRuns)
      held_out.back().robot =
          robot_without(dataset.robot, fit, lower, fit_sums(dataset.robot, {run}, 0, kBlock_s));
  }
  return held_out;
}

CalibrationResult calibrate_full(const Dataset& dataset, const std::vector<SmoothedRun>& runs) {
  const Robot& robot = dataset.robot;
  const std::vector<FitSums> units = fit_sums(robot, runs, kFewestRuns, kBlock_s);
  const FitValues nominal = nominal_values(robot), lower = lower_bounds(robot);
  Fit fit;
  for (const FitSums& unit : units) fit.all += unit;
  if (fit.all.torque_count < 100)
    refuse(
        dataset,
        "wheels that turn one way in " + std::to_string(static_cast<long>(fit.all.torque_count)) + " samples",
        "at least 100 samples above 0.3 rad/s", "the sign of friction is unknown at rest");
  fit.can = identifiable(fit.all, nominal);
  if (std::none_of(fit.can.free.begin(), fit.can.free.end(), [](bool free) { return free; }))
    refuse(dataset, "runs that excite no parameter", "runs with several speeds and accelerations", {});
  fit.weights = fit_weights(fit.all, nominal, fit.can.free);
  fit.result = fit_full(fit.all, fit.weights, nominal, lower, fit.can.free);

  CalibrationResult result{.method = CalibrationMethod::full, .robot = robot_with(robot, fit.result.values)};
  result.runs_used = runs.size(), result.samples_used = fit.all.samples;
  result.resampled = runs.size() < kFewestRuns ? blocks_text() : "runs";
  result.current_rms_before_A = std::sqrt(current_mean_square_A2(fit.all, nominal));
  result.current_rms_after_A = std::sqrt(current_mean_square_A2(fit.all, fit.result.values));
  if (fit.all.voltage_count > 0) {
    result.voltage_rms_before_V = std::sqrt(voltage_mean_square_V2(fit.all, nominal));
    result.voltage_rms_after_V = std::sqrt(voltage_mean_square_V2(fit.all, fit.result.values));
  }
  if (!fit.result.converged) result.notes.push_back("the solver stopped before it converged");
  const FittedErrors errors = add_parameters(dataset, units, fit, lower, result);
  write_errors(result.parameters, written_keys(), errors, result.robot);
  result.notes.push_back(write_model_energy(held_out_runs(dataset, runs, fit, lower), result.robot));
  return result;
}

}  // namespace

void state_interval(CalibratedParameter& parameter) {
  const double half = student_t_975(parameter.effective_runs - 1) * parameter.standard_deviation;
  parameter.interval_95 = {parameter.value - half, parameter.value + half};
  parameter.visibility = 2 * half > 0.5 * std::abs(parameter.value) ? Visibility::weak : Visibility::seen;
}

CalibrationResult calibrate(const Dataset& dataset, CalibrationMethod method) {
  if (!dataset.robot.effects.empty())
    throw ConfigError({.mark = {.file = dataset.robot_file.empty() ? dataset.file : dataset.robot_file},
                       .key = "effects",
                       .found = std::to_string(dataset.robot.effects.size()) + " effects",
                       .accepted = "a robot without effects",
                       .hint = "calibration fits the nominal model and would absorb the effects"});
  const std::vector<SmoothedRun> runs = smooth_runs(dataset);
  if (runs.empty()) refuse_channels(dataset);
  CalibrationResult result =
      method == CalibrationMethod::steady ? calibrate_steady(dataset, runs) : calibrate_full(dataset, runs);
  for (const Run& run : dataset.runs)
    if (run.current_sign_from_motion) {
      result.notes.push_back(
          "currents are unsigned in the logs: signs come from the motion, and braking is excluded");
      break;
    }
  for (const Run& run : dataset.runs)
    if (!run.payload_known) {
      result.notes.push_back("the payload is not stated in every run: 0 kg is assumed");
      break;
    }
  return result;
}

}  // namespace joulepath
