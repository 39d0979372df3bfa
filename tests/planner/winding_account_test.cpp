// Windings over a mission: forecast, limit kept by a price of heat, verdicts with what would do.
#include "planner/accounts/winding_account.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "planner/cache/answer_cache.hpp"
#include "planner/mission/mission.hpp"
#include "tests/support/tug.hpp"

namespace joulepath {
namespace {

using testing::highest_C;
using testing::starts;
using testing::tow;
using testing::tug;

bool is_towed(const Plan& plan) { return plan.status <= SolveStatus::feasible; }

TEST(WindingAccount, AgreesWithStepsAlongTheRowsOfThePlan) {
  const Robot robot = tug(400);
  const Plan plan = tow(starts(12), robot);
  ASSERT_TRUE(is_towed(plan)) << plan.message;
  ASSERT_TRUE(plan.winding);
  const Sided<double> most_C = highest_C(plan, robot);
  EXPECT_NEAR(plan.winding->highest_C, std::max(most_C.left, most_C.right), 1.0);
  EXPECT_GT(plan.winding->highest_C, 45);
}

/// Equal starts: after each one the rise is q x + h, so it approaches h/(1 - q).
TEST(WindingAccount, EqualStartsApproachTheirStationaryCycle) {
  const Plan plan = tow(starts(24), tug(400));
  ASSERT_TRUE(is_towed(plan)) << plan.message;
  const auto rise_K = [&](std::size_t leg) { return plan.winding->after_leg_C[leg].left - 25; };
  const double q = (rise_K(2) - rise_K(1)) / (rise_K(1) - rise_K(0)), stationary_K = rise_K(0) / (1 - q);
  EXPECT_GT(q, 0.5);
  EXPECT_NEAR(rise_K(23), stationary_K * (1 - std::pow(q, 24)), 0.02 * stationary_K);
}

TEST(WindingAccount, TheResistanceOfALegIsTheOneOfItsTemperature) {
  const Plan plan = tow(starts(8), tug(400));
  ASSERT_TRUE(is_towed(plan)) << plan.message;
  for (std::size_t k = 0; k < plan.legs.size(); ++k)
    for (const Side side : kSides) {
      const double before_C = k == 0 ? 25 : plan.winding->after_leg_C[k - 1][side];
      const double factor = plan.legs[k].state.resistance_factor[side];
      EXPECT_GE(factor, (235 + before_C) / 260 - 1e-3) << k;
      EXPECT_LE(factor, (235 + plan.winding->hottest_on_leg_C[k][side]) / 260 + 1e-3) << k;
    }
  EXPECT_GT(plan.legs.back().energy.copper_J, 1.02 * plan.legs.front().energy.copper_J);
}

TEST(WindingLimit, IsKeptBySpeedWhereTimeIsFree) {
  const Plan hot = tow(starts(5), tug(400));
  ASSERT_TRUE(is_towed(hot)) << hot.message;
  const double limit_C = 25 + 0.8 * (hot.winding->highest_C - 25);
  const Robot robot = tug(limit_C);
  const Plan cool = tow(starts(5), robot);
  ASSERT_TRUE(is_towed(cool)) << cool.message;
  EXPECT_LE(cool.winding->highest_C, limit_C);
  EXPECT_GT(cool.winding->price_of_heat, 0);
  EXPECT_GT(cool.duration_s, hot.duration_s);
  EXPECT_LE(cool.worst_violation, 1e-6);
  const Sided<double> most_C = highest_C(cool, robot);
  EXPECT_NEAR(cool.winding->highest_C, std::max(most_C.left, most_C.right), 1.0);
  EXPECT_LT(cool.energy.total_J(), 1.2 * hot.energy.total_J());
  EXPECT_LE(cool.lower_bound_J, hot.energy.total_J()) << "the plan without the limit is one of all plans";
}

/// A tug whose windings heat up within a leg: a price of the whole heat does not lower their peak.
Robot quick_tug(double max_winding_C) {
  Robot robot = tug(max_winding_C);
  for (const Side side : kSides) robot.motor[side].thermal->capacity_J_K = 0.8;
  return robot;
}

/// The limit at a share of the rise that a mission has without one.
double limit_at_C(double share, const Plan& hot) { return 25 + share * (hot.winding->highest_C - 25); }

TEST(WindingLimit, IsKeptWhereWindingsHeatUpWithinALeg) {
  const Plan hot = tow(starts(2), quick_tug(2000));
  ASSERT_TRUE(is_towed(hot)) << hot.message;
  for (const double share : {0.9, 0.6, 0.4}) {
    const Robot robot = quick_tug(limit_at_C(share, hot));
    const Plan cool = tow(starts(2), robot);
    ASSERT_TRUE(is_towed(cool)) << share << cool.message;
    EXPECT_LE(cool.winding->highest_C, limit_at_C(share, hot)) << share;
    const Sided<double> most_C = highest_C(cool, robot);
    EXPECT_NEAR(cool.winding->highest_C, std::max(most_C.left, most_C.right), 1.0) << share;
    EXPECT_LE(cool.worst_violation, 1e-6) << share;
    EXPECT_LE(cool.lower_bound_J, hot.energy.total_J() * (1 + 1e-9)) << share;
  }
}

/// Windings that are far below their limit leave the least time as it is; others take longer, less so with a
/// higher limit.
TEST(WindingLimit, IsKeptInTheLeastTime) {
  MissionRequest mission = starts(3);
  mission.objective.minimize = Objective::Minimize::time;
  const Plan hot = tow(mission, tug(2000));
  ASSERT_TRUE(is_towed(hot)) << hot.message;
  double before_s = hot.duration_s;
  for (const double share : {0.9, 0.7, 0.5}) {
    const Plan cool = tow(mission, tug(limit_at_C(share, hot)));
    ASSERT_TRUE(is_towed(cool)) << share << cool.message;
    EXPECT_LE(cool.winding->highest_C, limit_at_C(share, hot)) << share;
    EXPECT_GT(cool.winding->highest_C, limit_at_C(share - 0.05, hot)) << share;
    EXPECT_GT(cool.duration_s, before_s) << share;
    before_s = cool.duration_s;
  }
}

MissionRequest prescribed_starts(int count, double speed_m_s, double acceleration_m_s2) {
  MissionRequest mission{.name = "prescribed"};
  const PrescribedMotion motion{.profile = MotionProfile::trapezoid,
                                .acceleration_m_s2 = acceleration_m_s2,
                                .speed_m_s = speed_m_s,
                                .distance_m = 6};
  for (int k = 0; k < count; ++k)
    mission.legs.push_back({.motion = motion, .payload = {400, 400}, .dwell_s = 1});
  return mission;
}

/// No motion in the same windings, cold as it begins, needs less than the bound: with braking that returns
/// energy, and where the motors' power binds.
TEST(WindingLimit, NoMotionNeedsLessThanItsBound) {
  Robot robot = tug(400);
  robot.power.regeneration_efficiency = 0.9;
  robot.limits->motor_power_W = 60;
  const Plan hot = tow(starts(4), robot);
  ASSERT_TRUE(is_towed(hot)) << hot.message;
  const double dearest_J = hot.energy.total_J();
  for (const Side side : kSides)
    robot.motor[side].thermal->max_winding_C = 25 + 0.8 * (hot.winding->highest_C - 25);
  const Plan cool = tow(starts(4), robot);
  ASSERT_TRUE(is_towed(cool)) << cool.message;
  ASSERT_GT(cool.winding->price_of_heat, 0);
  EXPECT_LE(cool.worst_violation, 1e-6);
  EXPECT_LE(cool.lower_bound_J, dearest_J);
  EXPECT_NEAR(cool.gap_percent, 100 * (1 - cool.lower_bound_J / cool.energy.total_J()), 1e-9);
  int driven = 0;
  for (const double speed_m_s : {0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5, 0.6})
    for (const double acceleration_m_s2 : {0.03, 0.1, 0.35}) {
      const Plan other = tow(prescribed_starts(4, speed_m_s, acceleration_m_s2), robot);
      if (!is_towed(other)) continue;
      ++driven;
      EXPECT_GE(other.energy.total_J(), cool.lower_bound_J) << speed_m_s << " " << acceleration_m_s2;
    }
  EXPECT_GT(driven, 3);
}

/// Two solvers that evaluate the energy by different code pay the same price.
TEST(WindingLimit, BothSolversAgree) {
  const Plan hot = tow(starts(2), tug(400));
  const Robot robot = tug(25 + 0.8 * (hot.winding->highest_C - 25));
  const Plan fast = tow(starts(2), robot);
  const Plan ipopt = plan_mission(starts(2), {.robot = robot},
                                  {.solver = SolverChoice::ipopt, .nodes = 25, .baselines = false});
  ASSERT_TRUE(is_towed(fast) && is_towed(ipopt)) << fast.message << ipopt.message;
  ASSERT_GT(fast.winding->price_of_heat, 0);
  EXPECT_NEAR(ipopt.winding->price_of_heat, fast.winding->price_of_heat, 1e-3 * fast.winding->price_of_heat);
  EXPECT_NEAR(ipopt.energy.total_J(), fast.energy.total_J(), 1e-3 * fast.energy.total_J());
}

/// A plan does not depend on what was planned before.
TEST(WindingLimit, ACacheChangesNothing) {
  const Plan hot = tow(starts(3), tug(400));
  const Robot robot = tug(25 + 0.8 * (hot.winding->highest_C - 25));
  const Plan alone = tow(starts(3), robot);
  AnswerCache cache(100'000'000);
  PlanOptions options{.solver = SolverChoice::fast, .nodes = 25, .baselines = false};
  options.answers.cache = &cache;
  for (int round = 0; round < 2; ++round) {
    const Plan again = plan_mission(starts(3), {.robot = robot}, options);
    EXPECT_EQ(again.energy.total_J(), alone.energy.total_J()) << round;
    EXPECT_EQ(again.winding->highest_C, alone.winding->highest_C) << round;
    EXPECT_EQ(again.winding->price_of_heat, alone.winding->price_of_heat) << round;
  }
}

/// Legs that are passed at speed have no stop at which a dwell could cool.
TEST(WindingLimit, LegsAtSpeedGetNoDwell) {
  MissionRequest mission = starts(3, 400, 0);
  mission.objective.minimize = Objective::Minimize::time;
  mission.legs[0].end_speed_m_s = mission.legs[1].start_speed_m_s = 0.3;
  const Plan hot = tow(mission, tug(400));
  ASSERT_TRUE(is_towed(hot)) << hot.message;
  for (std::size_t k = 0; k < mission.legs.size(); ++k)  // no time to drive more gently
    mission.legs[k].duration_s = 1.001 * hot.legs[k].duration_s;
  const Plan refused = tow(mission, tug(25 + 0.9 * (hot.winding->highest_C - 25)));
  ASSERT_TRUE(refused.infeasibility) << refused.message;
  EXPECT_EQ(refused.infeasibility->reason.constraint, "winding_temperature");
  ASSERT_TRUE(refused.infeasibility->reason.relaxation.contains("dwell_s")) << refused.message;
  for (std::size_t k = 1; k < mission.legs.size(); ++k)
    mission.legs[k].dwell_s = refused.infeasibility->reason.relaxation.at("dwell_s");
  EXPECT_TRUE(is_towed(tow(mission, tug(25 + 0.9 * (hot.winding->highest_C - 25)))));
}

/// A motion that is given leaves no speed to give up: the verdict names leg, time and what was planned
/// instead.
TEST(WindingLimit, ATooHotMissionIsOfferedADwellAndLessPayload) {
  const MissionRequest mission = prescribed_starts(8, 0.8, 0.35);
  const Plan hot = tow(mission, tug(400));
  ASSERT_TRUE(is_towed(hot)) << hot.message;
  const Robot robot = tug(25 + 0.75 * (hot.winding->highest_C - 25));
  const Plan refused = tow(mission, robot);
  ASSERT_TRUE(refused.infeasibility) << refused.message;
  const Infeasibility& verdict = refused.infeasibility->reason;
  EXPECT_EQ(verdict.constraint, "winding_temperature");
  EXPECT_GT(refused.infeasibility->leg, 0u);
  EXPECT_NE(refused.message.find("s after the mission's start"), std::string::npos) << refused.message;
  ASSERT_TRUE(verdict.relaxation.contains("dwell_s")) << refused.message;
  ASSERT_TRUE(verdict.relaxation.contains("payload_kg")) << refused.message;
  MissionRequest rests = mission, lighter = mission;
  const double dwell_s = verdict.relaxation.at("dwell_s"), payload_kg = verdict.relaxation.at("payload_kg");
  for (LegRequest& leg : rests.legs) leg.dwell_s = dwell_s;
  for (LegRequest& leg : lighter.legs) leg.payload = {payload_kg, payload_kg};
  EXPECT_LT(payload_kg, 400);
  EXPECT_TRUE(is_towed(tow(rests, robot)));
  EXPECT_TRUE(is_towed(tow(lighter, robot)));
  for (LegRequest& leg : rests.legs) leg.dwell_s = 0.7 * dwell_s;
  for (LegRequest& leg : lighter.legs) leg.payload = {payload_kg + 40, payload_kg + 40};
  EXPECT_FALSE(is_towed(tow(rests, robot)));
  EXPECT_FALSE(is_towed(tow(lighter, robot)));
}

TEST(WindingAccount, AMotorWithoutThermalHasNone) {
  EXPECT_FALSE(tow(starts(1, 0), testing::nomad()).winding);
}

}  // namespace
}  // namespace joulepath
