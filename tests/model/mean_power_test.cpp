// Means of powers over a normal kernel, against sums over the kernel.
#include "model/mean_power.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// Mean of a function of the distance from the middle, in standard deviations.
template <class Function>
double mean_over_kernel(Function&& value) {
  double sum = 0, weights = 0;
  for (int k = -4000; k <= 4000; ++k) {
    const double z = 0.002 * k, weight = std::exp(-0.5 * z * z);
    sum += weight * value(z), weights += weight;
  }
  return sum / weights;
}

TEST(MeanPower, CountsThePositivePart) {
  for (const double mean_W : {-7.0, -0.5, 0.0, 0.1, 3.0, 1e4})
    for (const double change_W : {0.0, 0.2, -1.0, 5.0})
      EXPECT_NEAR(mean_positive_W(mean_W, change_W),
                  mean_over_kernel([&](double z) { return std::max(0.0, mean_W + z * change_W); }), 2e-6)
          << mean_W << ' ' << change_W;
}

TEST(MeanPower, IsSharedAsTheSupplyDoes) {
  const Sided<double> mean_W{4.0, -3.0}, change_W{1.0, 2.0};
  for (const PowerSharing sharing : {PowerSharing::wheel, PowerSharing::bus}) {
    const PowerSupply supply{.regeneration_efficiency = 0.4, .sharing = sharing};
    const double due_W = mean_over_kernel([&](double z) {
      return supply_power_W(supply, {mean_W.left + z * change_W.left, mean_W.right + z * change_W.right});
    });
    EXPECT_NEAR(mean_supply_power_W(supply, mean_W, change_W), due_W, 2e-6);
    const SupplyShares shares = supply_shares(sharing, mean_W, change_W);
    EXPECT_NEAR(shares.draw_W + shares.return_W, mean_W.left + mean_W.right, 1e-12);
    EXPECT_GE(shares.mixed_W, 0);
    EXPECT_LE(shares.mixed_W, std::min(shares.draw_W, -shares.return_W));
  }
  EXPECT_EQ(supply_shares(PowerSharing::wheel, {4.0, -3.0}, {0, 0}).mixed_W, 0.0);
}

/// While speed and acceleration change evenly, the mean of V i is the product of the means and what
/// product_W() adds.
TEST(MeanPower, OfAProductHasTheCovariance) {
  const Plant plant = make_plant(testing::nomad());
  const BodyMotion<double> motion{.speed_m_s = 0.6, .acceleration_m_s2 = 0.3, .yaw_rate_rad_s = 0.4};
  const Twist<double> jerk{2.0, -1.0};
  constexpr double kSigma_s = 0.05;
  const Site site = site_of(plant.robot.geometry, {}, 2.0, motion.speed_m_s, motion.yaw_rate_rad_s);
  const auto at = [&](double z) {
    const double t = z * kSigma_s;
    return operating_point(plant,
                           BodyMotion<double>{motion.speed_m_s + t * motion.acceleration_m_s2,
                                              motion.acceleration_m_s2 + t * jerk.speed_m_s, motion.yaw_rate_rad_s,
                                              t * jerk.yaw_rate_rad_s},
                           site);
  };
  const Sided<WheelChange> change = change_within(plant, motion, jerk, site, kSigma_s);
  for (const Side side : kSides) {
    const double product_W = at(0)[side].voltage_V * at(0)[side].current_A;
    const double mean_W = mean_over_kernel([&](double z) { return at(z)[side].power_W; });
    EXPECT_GT(std::abs(mean_W - product_W), 1e-3);
    EXPECT_NEAR(product_W + change[side].product_W(), mean_W, 0.02 * std::abs(mean_W - product_W));
  }
  EXPECT_EQ(change_within(plant, motion, jerk, site, 0).left.power_W, 0.0);
}

}  // namespace
}  // namespace joulepath
