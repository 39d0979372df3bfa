#include <gtest/gtest.h>

#include <cmath>

#include "benchmarks/paper/coefficients.hpp"
#include "benchmarks/paper/drive.hpp"
#include "benchmarks/paper/printed.hpp"
#include "model/operating_point.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "tests/support/locations.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath::bench {
namespace {

const std::string kScenarios = JOULEPATH_SOURCE_DIR "/scenarios/paper/";

TEST(PaperCoefficients, AreThePolynomialOfTheModelsStraightLinePower) {
  const Robot robot = testing::nomad();
  const Plant plant = make_nominal_plant(robot);
  for (double kg : {0.0, 5.7})
    for (double a : {-3.0, 0.0, 2.5})
      for (double w : {0.5, 9.0}) {
        const BodyMotion<double> motion{.speed_m_s = 0.1 * w, .acceleration_m_s2 = 0.1 * a};
        const auto wheels = operating_point(plant, motion, site_of(robot.geometry, {}, kg, 1.0, 0.0));
        for (Side side : kSides)
          EXPECT_NEAR(wheels[side].power_W,
                      polynomial_power_W(straight_line_coefficients(robot, side), a, w, kg) +
                          dropped_coefficient(robot, side) * a * a * kg * kg,
                      1e-12);
      }
}

TEST(PaperCoefficients, SevenOfNineOnEachSideAreWithinPrintedRounding) {
  const Robot robot = read_robot(kScenarios + "nomad_super_scout.yaml");
  for (Side side : kSides) {
    const PowerCoefficients ours = straight_line_coefficients(robot, side);
    int within = 0;
    for (std::size_t i = 0; i < ours.size(); ++i)
      within += std::abs(ours[i] - printed::kCoefficients[side][i]) <=
                printed::kCoefficientRounding[side][i] * (1 + 1e-9);
    EXPECT_EQ(within, 7) << side_name(side);
  }
}

TEST(PaperProtocol, EveryProfileCoversItsDistanceWithoutAJumpInSpeed) {
  for (const SpeedProfile& profile : {ramp_then_cruise(0.1, 0.2, 4, 10), repeated_ramps(0.25, 4, 0.8, 10),
                                      accelerate_throughout(0.2, 0.15, 10), up_and_down(0.1, 0.2, 10)}) {
    double distance_m = 0, speed_m_s = profile.front().start_speed_m_s;
    for (const Phase& phase : profile) {
      EXPECT_NEAR(phase.start_speed_m_s, speed_m_s, 1e-12);
      distance_m += phase.distance_m();
      speed_m_s = phase.start_speed_m_s + phase.acceleration_m_s2 * phase.duration_s;
    }
    EXPECT_NEAR(distance_m, 10.0, 1e-9);
  }
}

TEST(PaperDrive, MirroredCurvesSwapTheWheelsOfARobotWithEqualMotors) {
  Robot robot = testing::nomad();
  robot.motor.right = robot.motor.left;
  const Plant plant = make_nominal_plant(robot);
  const Track left = paper_curve(1), right = paper_curve(-1);
  const SpeedProfile profile = ramp_then_cruise(0.2, 0.18, 4, left.length_m());
  const Sided<double> a = drive_energy_J(plant, 0, left, profile, NegativePower::lost);
  const Sided<double> b = drive_energy_J(plant, 0, right, profile, NegativePower::lost);
  EXPECT_NEAR(a.left, b.right, 1e-9);
  EXPECT_NEAR(a.right, b.left, 1e-9);
  EXPECT_GT(a.right, a.left);  // turning left, the right wheel is the outer one
}

TEST(PaperScenarios, HoldAllRunsOfThePaper) {
  EXPECT_EQ(read_mission(kScenarios + "straight_runs.yaml").legs.size(), 30u);
  EXPECT_EQ(read_mission(kScenarios + "bezier_runs.yaml").legs.size(), 32u);
  EXPECT_EQ(read_mission(kScenarios + "calibration_runs.yaml").legs.size(), 9u);
  EXPECT_EQ(read_dataset(kScenarios + "straight_measured.yaml").runs.size(), 12u);
  EXPECT_EQ(read_dataset(kScenarios + "bezier_measured.yaml").runs.size(), 9u);
}

TEST(PaperScenarios, LoadedStraightRowsHaveTheErrorsOfTheColumnFor57Kg) {
  const Dataset dataset = read_dataset(kScenarios + "straight_measured.yaml");
  for (std::size_t i = 0; i < 6; ++i) {
    const Sided<double> measured = dataset.runs[6 + i].measured_energy_J.value();
    const Sided<double> estimated = printed::kStraight[6 + i].estimated_J;
    const double error_percent =
        100 * std::abs((estimated.left + estimated.right) / (measured.left + measured.right) - 1);
    EXPECT_NEAR(error_percent, printed::kStraightErrors[i][2], 0.0051);
  }
}

}  // namespace
}  // namespace joulepath::bench
