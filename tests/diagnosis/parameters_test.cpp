// Intervals of found parameters, by the propagation of a known covariance.
#include "diagnosis/correction/parameters.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "diagnosis/thresholds.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

constexpr double kStudent9 = 2.262157;  ///< 0.975 quantile of Student's t for ten runs

/// A slope towards y whose components are known to `sd`, from ten runs.
Refit slope_known_to(double grade, double sd) {
  Refit fitted;
  const Candidate slope = bare_candidate(*find_effect("floor_slope"), testing::nomad());
  fitted.state.effects = {{slope, {0.0, grade}}};
  fitted.equations.columns = {{Column::Kind::amplitude, 0, 0, 1.0, 0.0},
                              {Column::Kind::amplitude, 0, 1, 1.0, 0.0}};
  fitted.columns = {0, 1};
  fitted.covariance = sd * sd * Eigen::Matrix2d::Identity();
  fitted.run_covariance = Eigen::Matrix2d::Zero();
  fitted.fit_runs = 10;
  return fitted;
}

/// A direction is known to sd/size; the size in addition to what a law leaves out.
TEST(FoundParameters, OfASlopeAreItsSizeAndItsDirection) {
  constexpr double kGrade = 0.02, kSd = 1e-3;
  const std::vector<FoundParameter> found =
      found_parameters(slope_known_to(kGrade, kSd), 0, testing::nomad());
  ASSERT_EQ(found.size(), 2u);
  for (const FoundParameter& parameter : found) {
    const bool direction = parameter.name == "uphill_direction_rad";
    const double value = direction ? std::numbers::pi / 2 : kGrade,
                 sd = direction ? kSd / kGrade : std::hypot(kSd, kLawInexactness * kGrade);
    EXPECT_NEAR(parameter.value, value, 1e-12) << parameter.name;
    EXPECT_NEAR(parameter.interval_95.first, value - kStudent9 * sd, 1e-6 * sd) << parameter.name;
    EXPECT_NEAR(parameter.interval_95.second, value + kStudent9 * sd, 1e-6 * sd) << parameter.name;
  }
}

/// A patch of ten runs along one lane: the strength is known to `sd` where the north edge is held. A step of
/// the edge past the lane takes the patch away, which reads as if a strength could make up for it.
Refit patch_beside_its_lane(double coefficient, double sd) {
  constexpr double kEdgeSd_m = 0.1;
  Refit fitted;
  Candidate patch = bare_candidate(*find_effect("floor_patch"), testing::nomad());
  patch.shape.parameters = {{"x_min_m", 3.0}, {"x_max_m", 5.0}, {"y_min_m", -1.7}, {"y_max_m", 0.04}};
  fitted.state.effects = {{patch, {coefficient}}};
  fitted.equations.columns = {{Column::Kind::amplitude, 0, 0, 1.0, 0.0},
                              {Column::Kind::shape, 0, 3, kEdgeSd_m, 0.0}};
  fitted.columns = {0, 1};
  fitted.covariance = Eigen::Matrix2d{{sd * sd + coefficient * coefficient, -coefficient * kEdgeSd_m},
                                      {-coefficient * kEdgeSd_m, kEdgeSd_m * kEdgeSd_m}};
  fitted.run_covariance = fitted.covariance;
  fitted.fit_runs = 10;
  return fitted;
}

TEST(FoundParameters, OfAPatchAreItsStrengthWithinItsEdges) {
  constexpr double kCoefficient = 0.007, kSd = 1e-4;
  const std::vector<FoundParameter> found =
      found_parameters(patch_beside_its_lane(kCoefficient, kSd), 0, testing::nomad());
  ASSERT_EQ(found.front().name, "coefficient");
  const double sd = std::hypot(kSd, kLawInexactness * kCoefficient);
  EXPECT_NEAR(found.front().interval_95.first, kCoefficient - kStudent9 * sd, 1e-6 * sd);
  ASSERT_EQ(found.back().name, "y_max_m");
  EXPECT_NEAR(found.back().interval_95.second, 0.04 + kStudent9 * 0.1, 1e-6);
}

TEST(IsToldFromZero, APatchOfWhichAnEdgeRunsAlongTheLane) {
  EXPECT_TRUE(is_told_from_zero(patch_beside_its_lane(0.007, 0.002), 0));
  EXPECT_FALSE(is_told_from_zero(patch_beside_its_lane(0.007, 0.003), 0))
      << "2 F(2, 9) = 8.5: a strength and an edge were chosen";
}

/// The component along the lanes is known well, the one across them not at all: the slope is there.
TEST(IsToldFromZero, AVectorOfWhichOneComponentIsKnown) {
  Refit fitted = slope_known_to(0.009, 1e-5);
  fitted.covariance(1, 1) = fitted.run_covariance(1, 1) = 1e-4;
  EXPECT_FALSE(is_told_from_zero(fitted, 0));
  fitted.state.effects[0].amplitude[0] = 0.008;
  EXPECT_TRUE(is_told_from_zero(fitted, 0));
  EXPECT_FALSE(is_told_from_zero(slope_known_to(0.01, 0.004), 0))
      << "2 F(2, 9) = 8.5: less than 2.9 standard deviations";
  EXPECT_TRUE(is_told_from_zero(slope_known_to(0.01, 0.003), 0));
}

}  // namespace
}  // namespace joulepath
