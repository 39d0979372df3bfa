#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/values/dataset.hpp"

namespace joulepath {

enum class CalibrationMethod {
  steady,  ///< method of the paper: stretches of constant speed, [P1, Eq. (30)]; friction only
  full     ///< whole runs with voltages and currents: friction, R, Kt n, inertias
};

/// How well the data determine a parameter without prior knowledge.
enum class Visibility {
  seen,
  weak,   ///< the interval is wider than half of the value
  unseen  ///< the data do not determine the parameter; the value of the robot file is kept
};

struct CalibratedParameter {
  std::string name{};  ///< friction_torque_left_Nm, viscous_friction_Nm_s_rad, resistance_ohm, ...
  std::string unit{};
  double nominal{};                     ///< value of the robot file
  double value{};                       ///< calibrated value; nominal where unseen
  double standard_deviation{};          ///< from run-level resampling; NaN where unseen
  std::array<double, 2> interval_95{};  ///< value +/- Student's t times the deviation; NaN likewise
  double effective_runs{};              ///< effective number of runs that carry the information
  Visibility visibility{Visibility::unseen};
  std::string note{};  ///< why the parameter is unseen, or what its value depends on
};

/// Sets interval and visibility by Student's t from the value, its deviation and its effective runs.
void state_interval(CalibratedParameter& parameter);

/// Fit of [P1, Eq. (30)] to one motor: i = b1 + b2 q', V = c1 + c2 q' (signs of forward motion).
struct SteadyLine {
  double b1_A{}, b2_A_s_rad{}, c1_V{}, c2_V_s_rad{};
  bool has_voltage{};
};

struct SteadySegment {
  std::string run{};
  double start_s{};
  double duration_s{};
  Sided<double> speed_rad_s{};
  Sided<double> current_A{};
  Sided<double> voltage_V{};  ///< NaN where the log has no voltage
};

struct CalibrationResult {
  CalibrationMethod method{};
  std::vector<CalibratedParameter> parameters{};
  Robot robot{};  ///< with the calibrated values and their `uncertainty:`
  std::size_t runs_used{};
  std::size_t samples_used{};
  std::string resampled{};  ///< "runs", or "blocks of 10 s" where there are too few runs
  double current_rms_before_A{}, current_rms_after_A{};
  std::optional<double> voltage_rms_before_V{}, voltage_rms_after_V{};
  std::vector<SteadySegment> segments{};     ///< steady method
  std::optional<Sided<SteadyLine>> lines{};  ///< steady method
  std::vector<std::string> notes{};
};

/// Calibrates the dataset's robot from its runs.
///
/// The full method is a bounded nonlinear least squares fit of
///   Kt n i = J q''_mean +/- D q''_half_difference + nu q' + T_m sign(q') + payload and d terms,
///   V = R i + Kv n q'                                                [P1, Eqs. (14), (15), (17)]
/// with every channel smoothed by one kernel (docs/decisions/0511-calibration.md). The wheels determine J = m
/// r^2/2 + I_w + I_s and D = I r^2/(2 l^2) + I_w + I_s without payload; I_w + I_s and I_c follow from the
/// masses and lengths of the robot file. The ratio of Kt to Kv and the gear ratio keep the values of the
/// robot file.
///
/// Throws ConfigError with the missing data where the data cannot be used. A robot with `effects:` is
/// rejected, because the fit would absorb the effects.
[[nodiscard]] CalibrationResult calibrate(const Dataset& dataset, CalibrationMethod method);

}  // namespace joulepath
