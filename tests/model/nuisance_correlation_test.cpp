#include "model/nuisance_correlation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

Robot robot_with_correlations(std::vector<Correlation> pairs) {
  Robot robot = testing::nomad();
  robot.uncertainty = {{"friction_torque_Nm", 0.03}, {"viscous_friction_Nm_s_rad", 0.1},
                       {"resistance_ohm", 0.02},     {"gear_ratio", 0.0},
                       {"model_energy", 0.06},       {"payload_kg", 0.05}};
  robot.uncertainty_correlations = std::move(pairs);
  return robot;
}

TEST(NuisanceCorrelation, WithoutPairsErrorsAreIndependent) {
  const Eigen::MatrixXd matrix = nuisance_correlation(robot_with_correlations({}));
  EXPECT_EQ(matrix, Eigen::MatrixXd::Identity(5, 5));
  EXPECT_EQ(correlated_variance({1, 2, 3, 4, 5}, matrix), 0.0);
}

/// Both sides have the stated correlation; the inverse has a zero where two errors are independent given
/// all others.
TEST(NuisanceCorrelation, FrictionsSidesAreIndependentGivenTheOtherConstants) {
  const Robot robot = robot_with_correlations({{"viscous_friction_Nm_s_rad", "friction_torque_Nm", -0.87},
                                               {"friction_torque_Nm", "resistance_ohm", -0.2},
                                               {"resistance_ohm", "viscous_friction_Nm_s_rad", 0.4}});
  const std::vector<Nuisance> nuisances = nuisances_of(robot);
  ASSERT_EQ(nuisances[0].key + nuisances[1].key, "friction_torque_Nmfriction_torque_Nm");
  ASSERT_EQ(nuisances[4].key, "viscous_friction_Nm_s_rad");
  const Eigen::MatrixXd matrix = nuisance_correlation(robot);
  for (const Eigen::Index side : {0, 1}) EXPECT_EQ(matrix(side, 4), -0.87);
  EXPECT_NEAR(matrix.inverse()(0, 1), 0, 1e-12);
  EXPECT_GT(matrix(0, 1), 0.87 * 0.87);
  const auto factor = cholesky_factor(matrix);
  ASSERT_TRUE(factor);
  EXPECT_TRUE((*factor * factor->transpose()).isApprox(matrix, 1e-12));
  EXPECT_TRUE(factor->isLowerTriangular());
}

TEST(NuisanceCorrelation, ErrorsThatCannotBeTogetherHaveNoFactor) {
  const Robot robot = robot_with_correlations({{"friction_torque_Nm", "viscous_friction_Nm_s_rad", -0.9},
                                               {"friction_torque_Nm", "resistance_ohm", 0.9},
                                               {"resistance_ohm", "viscous_friction_Nm_s_rad", 0.5}});
  EXPECT_FALSE(cholesky_factor(nuisance_correlation(robot)));
  EXPECT_FALSE(cholesky_factor(Eigen::Matrix2d{{1, 1}, {1, 1}}));
  EXPECT_FALSE(cholesky_factor(Eigen::Matrix2d{{1, std::nan("")}, {std::nan(""), 1}}));
}

TEST(NuisanceCorrelation, OnlyErrorsOfTheCalibrationHaveOne) {
  const Robot robot = robot_with_correlations({});
  EXPECT_TRUE(may_correlate(robot, "friction_torque_Nm"));
  for (const char* key : {"gear_ratio", "model_energy", "payload_kg", "standby_W", ""})
    EXPECT_FALSE(may_correlate(robot, key)) << key;
}

}  // namespace
}  // namespace joulepath
