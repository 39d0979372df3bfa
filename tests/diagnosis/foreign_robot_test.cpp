// A robot file that belongs to another robot, told by the constants that the runs determine.
#include "diagnosis/checks/foreign_robot.hpp"

#include <gtest/gtest.h>

#include "diagnosis/values/diagnosis.hpp"
#include "scenarios/result_files/diagnosis_sentence.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"
#include "tests/support/typical_effect.hpp"

namespace joulepath {
namespace {

constexpr double kMeanPayload_kg = 4;

Dataset day_of(const Robot& real, const Robot& file) {
  Dataset dataset{.robot = file};
  for (unsigned r = 0; r < 6; ++r) {
    const double kind = r % 3;
    dataset.runs.push_back(testing::synthetic_run(
        real, "run_" + std::to_string(r), 12, r % 2 == 0 ? 0 : 8,
        testing::swinging((r % 3 == 0 ? -1 : 1) * (0.4 + 0.1 * kind), 0.2, 0.8 + 0.2 * kind, 0.2 * kind),
        {0.002, 0.005, 0.01}, r + 1));
  }
  return dataset;
}

std::vector<ForeignConstant> foreign_in(const Dataset& dataset) {
  std::vector<RunSignals> signals;
  for (std::size_t r = 0; r < dataset.runs.size(); ++r)
    signals.push_back(make_run_signals(dataset.runs[r], r, dataset.robot));
  return foreign_constants(dataset.robot, signals);
}

Robot with_mass(double factor) {
  Robot robot = testing::nomad();
  robot.inertia.chassis_mass_kg *= factor, robot.inertia.wheel_mass_kg *= factor;
  robot.inertia.wheel_axle_inertia_kg_m2 *= factor;
  return robot;
}

Robot with_motor(double resistance, double constants) {
  Robot robot = testing::nomad();
  for (Side side : kSides) {
    robot.motor[side].resistance_ohm *= resistance;
    robot.motor[side].torque_constant_Nm_A *= constants;
    robot.motor[side].voltage_constant_V_s_rad *= constants;
  }
  return robot;
}

TEST(ForeignRobot, IsToldByTheConstantsThatDiffer) {
  for (const double factor : {8.0, 0.1}) {
    const auto foreign = foreign_in(day_of(testing::nomad(), with_mass(factor)));
    ASSERT_EQ(foreign.size(), 1u) << factor;
    EXPECT_EQ(foreign[0].unit, "kg m^2");
    EXPECT_NEAR(foreign[0].in_runs, 0.01 * testing::nomad().total_mass_kg(kMeanPayload_kg) + 2 * 0.0281,
                0.03);
  }
  const auto motor = foreign_in(day_of(testing::nomad(), with_motor(0.2, 3)));
  ASSERT_EQ(motor.size(), 2u);
  EXPECT_NEAR(motor[0].in_runs, 2.74, 0.1);
  EXPECT_NEAR(motor[1].in_runs, 0.069 * 24.9, 0.02);
}

/// What the sentence states of the runs is theirs, whatever wheels the file has.
TEST(ForeignRobot, WhatTheRunsHaveDoesNotDependOnTheFile) {
  int told = 0;
  for (const double radius : {0.35, 0.7, 1.6})
    for (const double mass : {0.1, 8.0}) {
      Robot file = with_mass(mass);
      for (const Side side : kSides) file.geometry.wheel_radius_m[side] *= radius;
      const std::vector<ForeignConstant> foreign = foreign_in(day_of(testing::nomad(), file));
      told += foreign.empty() ? 0 : 1;
      for (const ForeignConstant& one : foreign) {
        const double true_value = one.unit == "ohm" ? 2.74
                                  : one.unit == "kg m^2"
                                      ? 0.01 * testing::nomad().total_mass_kg(kMeanPayload_kg) + 2 * 0.0281
                                      : 0.069 * 24.9;
        EXPECT_NEAR(one.in_runs, true_value, 0.1 * true_value) << one.name << ' ' << radius << ' ' << mass;
      }
    }
  EXPECT_GE(told, 4) << "of six files";
}

TEST(ForeignRobot, IsNotSeenInItsOwnFileNorInAScaledChannel) {
  EXPECT_TRUE(foreign_in(day_of(testing::nomad(), testing::nomad())).empty());
  EXPECT_TRUE(foreign_in(day_of(testing::nomad(), with_mass(1.8))).empty())
      << "a calibration error, or a load";
  for (const double scale : {1e-3, 0.2, 5.0, 1e3})
    for (int channel = 0; channel < 3; ++channel) {
      Dataset dataset = day_of(testing::nomad(), testing::nomad());
      for (joulepath::Run& run : dataset.runs)
        for (Side side : kSides)
          for (double& value : channel == 0   ? run.log.motor_voltage_V[side]
                               : channel == 1 ? run.log.motor_current_A[side]
                                              : run.log.wheel_speed_rad_s[side])
            value *= scale;
      EXPECT_TRUE(foreign_in(dataset).empty()) << scale << " on channel " << channel;
    }
}

TEST(ForeignRobot, IsNotSeenInAnEffectOfUsualSize) {
  for (const EffectDescription& effect : effect_catalog()) {
    Robot real = testing::nomad();
    real.effects = {testing::typical_effect(effect)};
    EXPECT_TRUE(foreign_in(day_of(real, testing::nomad())).empty()) << effect.info.name;
  }
}

/// A dead current of one run: its own fault with the robot's own file, and no excuse for another robot's.
TEST(ForeignRobot, IsToldBesideAFaultOfOneRun) {
  for (const double factor : {1.0, 8.0})
    for (const std::size_t faulty : {0u, 1u, 2u}) {
      Dataset day = day_of(testing::nomad(), with_mass(factor));
      std::ranges::fill(day.runs[faulty].log.motor_current_A.left, 0.0);
      const Diagnosis d = diagnose(day);
      EXPECT_EQ(d.foreign_constants.empty(), factor == 1.0) << factor << " in run " << faulty;
      EXPECT_EQ(d.verdict, factor == 1.0 ? Verdict::data_suspect : Verdict::unexplained) << faulty;
      EXPECT_FALSE(d.data_checks.empty()) << "another robot's file leaves the fault in the log: " << faulty;
    }
}

/// A file of a robot five times as heavy with strong motors: one scale of the currents would excuse it, which
/// the checks then have to find.
TEST(ForeignRobot, IsExcusedByAScaleOnlyWhereAChannelMayBeScaled) {
  Robot file = with_mass(5.2);
  for (Side side : kSides) {
    file.motor[side].resistance_ohm *= 0.15;
    file.motor[side].torque_constant_Nm_A *= 0.9;
    file.motor[side].voltage_constant_V_s_rad *= 0.9;
  }
  const Dataset day = day_of(testing::nomad(), file);
  std::vector<RunSignals> signals;
  for (std::size_t r = 0; r < day.runs.size(); ++r)
    signals.push_back(make_run_signals(day.runs[r], r, day.robot));
  EXPECT_TRUE(foreign_constants(day.robot, signals, true).empty());
  EXPECT_FALSE(foreign_constants(day.robot, signals, false).empty());
}

TEST(ForeignRobot, EndsTheDiagnosisWithoutACorrection) {
  const Diagnosis d = diagnose(day_of(testing::nomad(), with_mass(8)));
  EXPECT_EQ(d.verdict, Verdict::unexplained);
  EXPECT_TRUE(d.causes.empty());
  EXPECT_FALSE(d.corrected_robot);
  const std::string said = diagnosis_sentence(d);
  EXPECT_EQ(
      said.rfind("Unexplained: the robot file does not describe this robot: inertia that the wheels ", 0), 0u)
      << said;
}

}  // namespace
}  // namespace joulepath
