// Weights of the two equations of the full method, from sums with known residuals.
#include <gtest/gtest.h>

#include <utility>

#include "diagnosis/calibration/full_fit.hpp"
#include "diagnosis/calibration/smoothed_run.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath::calibration {
namespace {

constexpr double kRows = 100;

/// Left wheel forward and back at constant speeds of 1 rad/s: i = sign/K plus `error_A` of alternating sign;
/// V = R i + K q' plus `error_V`.
FitSums two_way_sums(double error_A, double error_V) {
  FitSums sums;
  sums.torque_count = sums.voltage_count = kRows;
  const auto add = [](auto& matrix, int a, int b, double value) { matrix(a, b) = matrix(b, a) = value; };
  add(sums.torque, kFrictionLeft, kFrictionLeft, kRows);
  add(sums.torque, kFrictionLeft, 7, kRows);
  add(sums.torque, 7, 7, kRows * (1 + error_A * error_A));
  for (int a : {6, 7})
    for (int b : {6, 7}) sums.voltage(a, b) = kRows;
  for (int a : {6, 7}) add(sums.voltage, a, 8, 2 * kRows);
  sums.voltage(8, 8) = kRows * (4 + error_V * error_V);
  return sums;
}

FitWeights weights_of(const FitSums& sums) {
  FitValues start{};
  start[kFrictionLeft] = 0.5;
  start[kTorquePerAmpere] = start[kResistance] = 1.0;
  FreeParameters free{};
  free[kFrictionLeft] = true;
  return fit_weights(sums, start, free);
}

TEST(FitWeights, AreTheInverseVariancesOfTheResiduals) {
  const FitWeights weights = weights_of(two_way_sums(0.5, 0.1));
  EXPECT_NEAR(weights.torque, 1 / 0.25, 1e-9);
  EXPECT_NEAR(weights.voltage, 1 / 0.01, 1e-9);
}

/// Without noise the residuals count as 1e-7 of the readings, whatever the number of samples.
TEST(FitWeights, OfExactReadingsAreBoundedByTheReadings) {
  const FitWeights weights = weights_of(two_way_sums(0, 0));
  EXPECT_NEAR(weights.torque, 1e14, 1e5);
  EXPECT_NEAR(weights.voltage, 1e14 / 4, 1e5);
}

TEST(FitWeights, WithoutVoltagesLeaveTheirEquationOut) {
  FitSums sums = two_way_sums(0.5, 0.1);
  sums.voltage.setZero();
  sums.voltage_count = 0;
  EXPECT_EQ(weights_of(sums).voltage, 0.0);
}

/// Wheels that keep their speed accelerate in their noise only, whose squares both equations take off.
TEST(FitSums, HoldNoSquaresOfTheSpeedsNoise) {
  Dataset dataset{.robot = testing::nomad()};
  for (unsigned seed = 1; seed <= 4; ++seed)
    dataset.runs.push_back(testing::synthetic_run(dataset.robot, "lane", 60, 0, testing::constant_speed(0.5),
                                                  {.speed_rad_s = 0.05}, seed));
  double torque = 0, voltage = 0, noise = 0;
  for (const FitSums& sums : fit_sums(dataset.robot, smooth_runs(dataset), 1, 60)) {
    torque += sums.torque(kTurningInertia, kTurningInertia) + sums.torque(kStraightInertia, kStraightInertia);
    voltage +=
        sums.voltage(kTurningInertia, kTurningInertia) + sums.voltage(kStraightInertia, kStraightInertia);
    noise += sums.acceleration_noise;
  }
  EXPECT_NEAR(torque, 0.0, 0.3 * noise);
  EXPECT_NEAR(voltage, 0.0, 0.3 * noise);
}

/// The current asks for K = 0.5, the voltage for K = 1: the fit is between them, and no neighbor is better.
TEST(FitFull, IsTheLeastOfBothWeightedSquares) {
  FitSums sums = two_way_sums(0, 0);
  // The sign of the motion is an instrument; i, q' and V have it.
  for (const auto& [column, value] :
       {std::pair{0, 1.0}, std::pair{6, 1.0}, std::pair{7, 1.0}, std::pair{8, 2.0}})
    sums.voltage(0, column) = sums.voltage(column, 0) = kRows * value;
  FitValues start{};
  start[kFrictionLeft] = 0.5;
  start[kTorquePerAmpere] = start[kResistance] = 1.0;
  FreeParameters free{};
  free[kTorquePerAmpere] = true;
  const FitWeights weights{2.0, 3.0};
  const FitResult result = fit_full(sums, weights, start, {}, free);
  ASSERT_TRUE(result.converged);
  const auto squares = [&](double torque_per_ampere) {
    FitValues values = result.values;
    values[kTorquePerAmpere] = torque_per_ampere;
    return weights.torque * current_mean_square_A2(sums, values) +
           weights.voltage * voltage_mean_square_V2(sums, values);
  };
  const double found = result.values[kTorquePerAmpere];
  EXPECT_GT(found, 0.5);
  EXPECT_LT(found, 1.0);
  for (const double other : {0.999 * found, 1.001 * found}) EXPECT_LT(squares(found), squares(other));
}

}  // namespace
}  // namespace joulepath::calibration
