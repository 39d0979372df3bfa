#include "model/motor_sheet.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace joulepath {
namespace {

/// A gear motor by its constants at the output, and the sheet that its maker would print.
struct KnownMotor {
  double R = 3.0, K = 1.5, friction_Nm = 0.09, loss = 0.25, voltage_V = 12.0;

  double no_load_rad_s() const { return (voltage_V - R * friction_Nm / ((1 - loss) * K)) / K; }
  SheetPoint at(double speed_rad_s) const {
    const double i = (voltage_V - K * speed_rad_s) / R;
    return {(1 - loss) * K * i - friction_Nm, speed_rad_s, i};
  }
  MotorSheet sheet() const {
    return {.nominal_voltage_V = voltage_V,
            .no_load_speed_rad_s = no_load_rad_s(),
            .no_load_current_A = at(no_load_rad_s()).current_A,
            .stall = at(0)};
  }
  void expect_equal(const SheetMotor& motor) const {
    EXPECT_NEAR(motor.resistance_ohm, R, 1e-9);
    EXPECT_NEAR(motor.torque_constant_Nm_A, K, 1e-9);
    EXPECT_NEAR(motor.friction_torque_Nm, friction_Nm, 1e-9);
    EXPECT_NEAR(motor.loss_fraction, loss, 1e-9);
  }
};

TEST(MotorSheet, GivesBackTheConstantsOfAKnownMotor) {
  KnownMotor{}.expect_equal(motor_of(KnownMotor{}.sheet()));
}

TEST(MotorSheet, ARatedPointInsteadOfStallGivesTheSameConstants) {
  const KnownMotor known;
  MotorSheet sheet = known.sheet();
  sheet.stall.reset();
  sheet.rated = known.at(0.7 * sheet.no_load_speed_rad_s);
  known.expect_equal(motor_of(sheet));
}

/// A servo with much friction in its gear: stall torque / stall current is no torque constant.
TEST(MotorSheet, StallTorquePerAmpereIsBelowTheConstantByTheLossOfTheGear) {
  const MotorSheet servo{.nominal_voltage_V = 11.1,
                         .no_load_speed_rad_s = 57 * kRpm_rad_s,
                         .no_load_current_A = 0.1,
                         .stall = SheetPoint{1.4, 0, 1.3},
                         .gear_ratio = 250};
  const SheetMotor motor = motor_of(servo);
  const double at_output = motor.torque_constant_Nm_A * 250;
  EXPECT_GT(at_output, 1.5 * 1.4 / 1.3);
  EXPECT_GT(motor.loss_fraction, 0.2);
  EXPECT_LT(motor.loss_fraction, 0.5);
}

TEST(MotorSheet, TheShaftOfTheSheetDoesNotChangeWhatTheWheelSees) {
  const double n = 20;
  const MotorSheet output = KnownMotor{}.sheet();
  MotorSheet at_output = output, at_motor = output;
  at_output.gear_ratio = at_motor.gear_ratio = n;
  at_motor.at_output = false;
  at_motor.no_load_speed_rad_s *= n;
  at_motor.stall->torque_Nm /= n;
  const SheetMotor a = motor_of(at_output), b = motor_of(at_motor);
  EXPECT_NEAR(a.torque_constant_Nm_A, b.torque_constant_Nm_A, 1e-12);
  EXPECT_NEAR(a.friction_torque_Nm, b.friction_torque_Nm, 1e-12);
  EXPECT_NEAR(a.loss_fraction, b.loss_fraction, 1e-12);
}

/// Two phases of a motor of three in series carry the current of one winding: with the peak flux linkage F of
/// a phase, R = 2 R_phase and K = sqrt(3) F give the power and torque of 3/2 R_phase i_q^2 and 3/2 F i_q.
TEST(MotorSheet, PhaseToPhaseValuesGiveThePowerOfFieldOrientedControl) {
  const double phase_ohm = 0.1, flux_Vs = 0.02, i_q_A = 7, torque_Nm = 1.5 * flux_Vs * i_q_A;
  MotorSheet sheet{.nominal_voltage_V = 24,
                   .no_load_speed_rad_s = 24 / (std::sqrt(3.0) * flux_Vs),
                   .no_load_current_A = 1e-9,
                   .resistance_ohm = 2 * phase_ohm,
                   .voltage_constant_V_s_rad = std::sqrt(3.0) * flux_Vs};
  const SheetMotor motor = motor_of(sheet);
  const double i_A = torque_Nm / motor.torque_constant_Nm_A;
  EXPECT_NEAR(motor.resistance_ohm * i_A * i_A, 1.5 * phase_ohm * i_q_A * i_q_A, 1e-12);
}

}  // namespace
}  // namespace joulepath
