#include <gtest/gtest.h>

#include "model/motions.hpp"
#include "planner/accounts/battery_account.hpp"
#include "planner/accounts/plan_accounts.hpp"
#include "planner/accounts/stretch_account.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

TEST(PlanAccounts, ABaselineOfAPlanIsTheSumOverItsLegs) {
  Plan plan;
  for (const double part : {1.0, 2.0}) {
    LegPlan leg;
    leg.prescribed.emplace();
    leg.baselines = {{.name = "trapezoid",
                      .energy_J = 10 * part,
                      .motion_energy_J = 4 * part,
                      .duration_s = 3 * part,
                      .later_s = part}};
    plan.legs.push_back(leg);
  }
  sum_up(plan, make_plant(testing::nomad()), 1e-6);
  ASSERT_EQ(plan.baselines.size(), 1u);
  EXPECT_DOUBLE_EQ(plan.baselines[0].energy_J, 30.0);
  EXPECT_DOUBLE_EQ(plan.baselines[0].motion_energy_J, 12.0);
  EXPECT_DOUBLE_EQ(plan.baselines[0].duration_s, 9.0);
  EXPECT_DOUBLE_EQ(plan.baselines[0].later_s, 3.0);
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
  EXPECT_NEAR(plan.energy_sigma_J, sigma_J, 1e-6 * sigma_J);
}

}  // namespace
}  // namespace joulepath
