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

/// The standby of a wait is in the energy but not in the bound, which may use the wait at the price of time.
TEST(PlanAccounts, AWaitCostsTheBoundItsPriceOfTime) {
  const Plant plant = make_plant(testing::nomad());
  const double wait_s = 5, price_W = 2, standby_W = plant.robot.power.standby_W;
  StretchPlan stretch{.request = {.piece = TurnInPlace{}}};
  stretch.energy.copper_J = 100, stretch.energy.standby_J = standby_W * wait_s;
  stretch.profile.wait_s = wait_s;
  stretch.summary.lower_bound_J = 99;
  LegPlan leg;
  leg.status = SolveStatus::feasible;
  leg.energy = stretch.energy, leg.price_of_time_W = price_W, leg.duration_s = wait_s;
  leg.stretches = {stretch};
  Plan plan;
  plan.legs = {leg};
  sum_up(plan, plant, 1e-6);
  const double gap_J = 1 + (price_W + standby_W) * wait_s;
  EXPECT_NEAR(plan.legs[0].lower_bound_J, leg.energy.total_J() - gap_J, 1e-9);
  EXPECT_NEAR(plan.legs[0].gap_percent, 100 * gap_J / leg.energy.total_J(), 1e-9);
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
