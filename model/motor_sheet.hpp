#pragma once

#include <numbers>
#include <optional>

namespace joulepath {

inline constexpr double kRpm_rad_s = std::numbers::pi / 30;

/// A point of operation that a data sheet states, at the shaft of the sheet.
struct SheetPoint {
  double torque_Nm{};
  double speed_rad_s{};
  double current_A{};
};

/// What the data sheet of a (gear) motor states at its nominal voltage, at one shaft.
struct MotorSheet {
  double nominal_voltage_V{};
  double no_load_speed_rad_s{};
  double no_load_current_A{};
  std::optional<SheetPoint> stall{}, rated{};
  std::optional<double> resistance_ohm{};            ///< stated, of two phases where it is brushless
  std::optional<double> voltage_constant_V_s_rad{};  ///< stated, at the motor's shaft
  double gear_ratio{1.0};
  bool at_output{true};  ///< speeds and torques are those of the gear's output
};

/// Constants of the model; friction is seen at the gear's output, which is the wheel.
struct SheetMotor {
  double resistance_ohm{};
  double torque_constant_Nm_A{};  ///< and voltage constant, at the motor's shaft
  double friction_torque_Nm{};
  /// Of the transmitted torque: gear_efficiency. Below 0 the sheet contradicts itself.
  double loss_fraction{};
};

// clang-format off
/// The constants that a data sheet states, by V = R i + K w and T = (1 - loss) K i - T_m at its shaft:
///
///   R = V / i_s                                  of the stall point, or
///   R = V (w_0 - w_r) / (i_r w_0 - i_0 w_r)      of no load and the rated point
///   K = (V - R i_0) / w_0
///   (1 - loss) K = T / (i - i_0)                 of the rated point, or of the stall point
///   T_m = (1 - loss) K i_0
///
/// In SI units the torque constant is the voltage constant (power is conserved); stall torque / stall current
/// is neither: it lacks what the gear loses. Both lines, current and torque over speed, have two points, so
/// that no sheet tells viscous friction from the loss of the gear: all friction at no load is Coulomb
/// friction. Requires positive voltage, speed and currents, and a stall or rated point or both stated
/// constants.
// clang-format on
[[nodiscard]] inline SheetMotor motor_of(const MotorSheet& sheet) {
  const double w0 = sheet.no_load_speed_rad_s, i0 = sheet.no_load_current_A, V = sheet.nominal_voltage_V;
  const double n = sheet.gear_ratio, to_motor = sheet.at_output ? n : 1.0,
               to_wheel = sheet.at_output ? 1.0 : n;
  SheetMotor motor;
  if (sheet.resistance_ohm)
    motor.resistance_ohm = *sheet.resistance_ohm;
  else if (sheet.stall)
    motor.resistance_ohm = V / sheet.stall->current_A;
  else
    motor.resistance_ohm =
        V * (w0 - sheet.rated->speed_rad_s) / (sheet.rated->current_A * w0 - i0 * sheet.rated->speed_rad_s);
  const double K = sheet.voltage_constant_V_s_rad ? *sheet.voltage_constant_V_s_rad * to_motor
                                                  : (V - motor.resistance_ohm * i0) / w0;
  const auto& point = sheet.rated ? sheet.rated : sheet.stall;
  const double passed_Nm_A = point ? point->torque_Nm / (point->current_A - i0) : K;
  motor.torque_constant_Nm_A = K / to_motor;
  motor.friction_torque_Nm = passed_Nm_A * i0 * to_wheel;
  motor.loss_fraction = 1 - passed_Nm_A / K;
  return motor;
}

}  // namespace joulepath
