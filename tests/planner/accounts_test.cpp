#include <gtest/gtest.h>

#include "model/motions.hpp"
#include "model/nuisance_correlation.hpp"
#include "planner/accounts/battery_account.hpp"
#include "planner/accounts/plan_accounts.hpp"
#include "planner/accounts/stretch_account.hpp"
#include "planner/legs/prescribed_leg.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// A prescribed motion is its own baseline.
TEST(PlanAccounts, ABaselineOfAPlanIsTheSumOverItsLegs) {
  Plan plan;
  for (const double part : {1.0, 2.0}) {
    LegPlan leg{.duration_s = 3 * part, .dwell_s = part};
    leg.prescribed.emplace();
    leg.energy.copper_J = 4 * part, leg.energy.standby_J = 6 * part;
    plan.legs.push_back(leg);
  }
  add_baselines(plan, 10.0, 1);
  ASSERT_EQ(plan.baselines.size(), 2u);
  for (const BaselineTotal& baseline : plan.baselines) {
    EXPECT_DOUBLE_EQ(baseline.energy_J, 30.0);
    EXPECT_DOUBLE_EQ(baseline.optimum_J, 30.0);
    EXPECT_DOUBLE_EQ(baseline.motion_energy_J, 12.0);
    EXPECT_DOUBLE_EQ(baseline.duration_s, 12.0);
    EXPECT_DOUBLE_EQ(baseline.later_s, 0.0);
  }
}

/// A slower drive may use the waiting time, so the bound counts a second of it at the price of time.
TEST(PlanAccounts, AWaitCostsTheBoundItsPriceOfTime) {
  const double wait_s = 5, price_W = 2;
  StretchPlan stretch{.request = {.piece = TurnInPlace{}, .plant = make_plant(testing::nomad())}};
  const double standby_W = stretch.request.plant.robot.power.standby_W;
  stretch.energy.copper_J = 100, stretch.energy.standby_J = standby_W * wait_s;
  stretch.profile.wait_s = wait_s;
  stretch.summary.lower_bound_J = 99;
  bound_wait(stretch, wait_s, price_W);
  const double gap_J = 1 + (price_W + standby_W) * wait_s;
  EXPECT_NEAR(stretch.summary.lower_bound_J, stretch.energy.total_J() - gap_J, 1e-9);
  EXPECT_NEAR(stretch.summary.gap_percent, 100 * gap_J / stretch.energy.total_J(), 1e-9);
}

/// Standby power is uncertain while a prescribed motion drives and while it waits.
TEST(PlanAccounts, APrescribedMotionSharesTheUncertainty) {
  Robot robot = testing::nomad();
  robot.uncertainty["standby_W"] = 0.1;
  PrescribedMotion motion{.profile = MotionProfile::trapezoid};
  motion.speed_m_s = 0.5, motion.distance_m = 4, motion.acceleration_m_s2 = 0.3;
  LegPlan leg;
  leg.prescribed = timed_motion(robot, {motion}).trajectory;
  leg.duration_s = leg.prescribed->time_s.back(), leg.dwell_s = 6;
  Plan plan;
  plan.legs = {leg};
  find_energy_sigmas(plan, uncertain(make_plant(robot)));
  const double sigma_J = 0.1 * robot.power.standby_W * (leg.duration_s + leg.dwell_s);
  ASSERT_TRUE(plan.energy_sigma_J);
  EXPECT_NEAR(*plan.energy_sigma_J, sigma_J, 1e-6 * sigma_J);
}

/// Errors of friction that a fit cannot tell from viscous friction cancel in the energy; the variance is the
/// quadratic form of the changes per sigma with the correlation matrix, for the plan and for a leg.
TEST(PlanAccounts, CorrelatedErrorsAddAsTheirCovariance) {
  Robot robot = testing::nomad();
  robot.uncertainty = {
      {"friction_torque_Nm", 0.02}, {"viscous_friction_Nm_s_rad", 0.9}, {"resistance_ohm", 0.02}};
  PrescribedMotion motion{.profile = MotionProfile::trapezoid};
  motion.speed_m_s = 0.5, motion.distance_m = 4, motion.acceleration_m_s2 = 0.3;
  LegPlan leg;
  leg.prescribed = timed_motion(robot, {motion}).trajectory;
  leg.duration_s = leg.prescribed->time_s.back();
  Plan plan;
  plan.legs = {leg, leg};
  const auto sigma_with = [&](const std::vector<Correlation>& pairs) {
    robot.uncertainty_correlations = pairs;
    find_energy_sigmas(plan, uncertain(make_plant(robot)));
    EXPECT_NEAR(*plan.legs[0].energy_sigma_J, 0.5 * *plan.energy_sigma_J, 1e-9 * *plan.energy_sigma_J);
    return *plan.energy_sigma_J;
  };
  const double independent_J = sigma_with({});
  const double together_J = sigma_with({{"friction_torque_Nm", "viscous_friction_Nm_s_rad", 0.8}});
  const double against_J = sigma_with({{"friction_torque_Nm", "viscous_friction_Nm_s_rad", -0.8}});
  EXPECT_LT(against_J, 0.8 * independent_J);
  EXPECT_GT(together_J, 1.1 * independent_J);
  // Left and right friction share the error of viscous friction: their correlation is 0.8^2 in both cases.
  const UncertainPlant plant = uncertain(make_plant(robot));
  const Eigen::MatrixXd correlation = nuisance_correlation(robot);
  Eigen::VectorXd shifts_J(std::ssize(plant.shifted));
  for (std::size_t k = 0; k < plant.shifted.size(); ++k)
    shifts_J[static_cast<Eigen::Index>(k)] = prescribed_energy(leg, plant.shifted[k][0]).total_J() -
                                             prescribed_energy(leg, plant.shifted[k][1]).total_J();
  EXPECT_NEAR(against_J, std::sqrt(shifts_J.dot(correlation * shifts_J)), 1e-6 * against_J);
}

}  // namespace
}  // namespace joulepath
