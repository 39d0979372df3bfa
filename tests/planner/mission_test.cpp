#include "planner/mission/mission.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "planner/accounts/plan_trajectory.hpp"
#include "planner/legs/leg_timing.hpp"
#include "planner/mission/plan_front.hpp"
#include "planner/profile/profile_solver.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

const std::vector<BezierPoints> kPaperCurve{{{{0, 0}, {2.7, 0}, {2.7, 0}, {2.7, 2.7}}}};
const std::vector<BezierPoints> kStraight{{{{0, 0}, {2, 0}, {4, 0}, {6, 0}}}};

/// Little standby power, so that a longer time saves energy.
Robot patient_nomad() {
  Robot robot = testing::nomad();
  robot.power.standby_W = 1.0;
  return robot;
}

LegRequest leg_along(std::vector<BezierPoints> curves, double payload_kg) {
  return {.path = PathRequest{.bezier_m = std::move(curves)}, .payload = {payload_kg, payload_kg}};
}

/// The paper's curve with 5.7 kg, then 6 m straight with 1 kg; 5 s of dwell between.
MissionRequest two_legs() {
  MissionRequest mission{.name = "two_legs",
                         .legs = {leg_along(kPaperCurve, 5.7), leg_along(kStraight, 1.0)}};
  mission.legs[0].dwell_s = 5.0;
  return mission;
}

Plan plan_of(const MissionRequest& mission, const Robot& robot = patient_nomad()) {
  return plan_mission(mission, {.robot = robot}, {.solver = SolverChoice::fast, .nodes = 60});
}

/// The same without the trapezoids beside it.
Plan lone_plan_of(const MissionRequest& mission, const Robot& robot = patient_nomad()) {
  return plan_mission(mission, {.robot = robot},
                      {.solver = SolverChoice::fast, .nodes = 60, .baselines = false});
}

double cause_sum_J(const EnergyByCause& energy) {
  double sum_J = energy.copper_J + energy.coulomb_friction_J + energy.viscous_friction_J + energy.kinetic_J +
                 energy.not_recovered_J + energy.standby_J;
  for (const auto& [name, energy_J] : energy.effects_J) sum_J += energy_J;
  return sum_J;
}

TEST(Mission, CausesAddUpToTheReplayedEnergyOnEveryLegAndInAll) {
  Robot robot = patient_nomad();
  robot.effects = {{.name = "rolling_resistance", .parameters = {{"coefficient", 0.01}}}};
  const Plan plan = plan_of(two_legs(), robot);
  ASSERT_EQ(plan.legs.size(), 2u) << plan.message;
  double sum_J = 0.0;
  for (const LegPlan& leg : plan.legs) {
    double replayed_J = 1.0 * leg.dwell_s;
    for (const StretchPlan& stretch : leg.stretches) replayed_J += stretch.replay.energy_J;
    EXPECT_NEAR(cause_sum_J(leg.energy), replayed_J, 1e-5 * replayed_J);
    EXPECT_GT(leg.energy.effects_J.at("rolling_resistance"), 1.0);
    sum_J += cause_sum_J(leg.energy);
  }
  EXPECT_NEAR(plan.energy.total_J(), sum_J, 1e-9 * sum_J);
  EXPECT_NEAR(plan.replay_energy_J, sum_J, 1e-5 * sum_J);
}

TEST(Mission, LegsThatShareADeadlineHaveOnePriceThatIsTheSlopeOfEnergyOverTime) {
  MissionRequest mission = two_legs();
  const double free_s = plan_of(mission).duration_s;
  mission.objective.deadline_s = 0.95 * free_s;
  const Plan plan = plan_of(mission);
  ASSERT_EQ(plan.legs.size(), 2u) << plan.message;
  EXPECT_NEAR(plan.duration_s, 0.95 * free_s, 1e-5 * free_s);
  EXPECT_LE(plan.duration_s, 0.95 * free_s * (1 + 1e-9));
  EXPECT_GT(plan.legs[0].price_of_time_W, 0.1);
  EXPECT_NEAR(plan.legs[0].price_of_time_W, plan.legs[1].price_of_time_W,
              1e-4 * plan.legs[0].price_of_time_W);
  // dE/dT by planning again with the deadline moved to both sides
  const double step_s = 0.004 * free_s;
  mission.objective.deadline_s = 0.95 * free_s + step_s;
  const double later_J = plan_of(mission).energy.total_J();
  mission.objective.deadline_s = 0.95 * free_s - step_s;
  const double earlier_J = plan_of(mission).energy.total_J();
  EXPECT_NEAR((earlier_J - later_J) / (2 * step_s), plan.legs[0].price_of_time_W,
              0.03 * plan.legs[0].price_of_time_W);
}

TEST(Mission, MorePayloadLessTimeAndTighterLimitsCostMore) {
  MissionRequest mission = two_legs();
  const Plan base = plan_of(mission);
  MissionRequest heavier = mission;
  heavier.legs[0].payload = {10.5, 10.5};
  EXPECT_GT(plan_of(heavier).energy.total_J(), base.energy.total_J());
  MissionRequest hurried = mission;
  hurried.objective.deadline_s = 0.95 * base.duration_s;
  EXPECT_GT(plan_of(hurried).energy.motion_J(), base.energy.motion_J());
  EXPECT_GT(plan_of(hurried).energy.total_J(), base.energy.total_J());
  Robot slow = patient_nomad();
  slow.limits->speed_m_s = 0.2;
  const Plan slower = plan_of(mission, slow);
  EXPECT_GT(slower.duration_s, base.duration_s);
  EXPECT_GT(slower.energy.total_J(), base.energy.total_J());
}

TEST(Mission, NeitherTrapezoidTakesLessOnAnyLegAndBothTakeMoreInAll) {
  const Plan plan = plan_of(two_legs());
  for (const LegPlan& leg : plan.legs)
    for (const BaselineTotal& baseline : leg.baselines)
      if (baseline.feasible) {
        EXPECT_LE(leg.energy.total_J(), baseline.energy_J * (1 + 1e-4)) << baseline.name;
      }
  ASSERT_EQ(plan.baselines.size(), 2u);
  for (const BaselineTotal& baseline : plan.baselines) {
    ASSERT_TRUE(baseline.feasible) << baseline.reason;
    EXPECT_LT(plan.energy.total_J(), baseline.energy_J);
    EXPECT_NEAR(baseline.duration_s, plan.duration_s, 1e-6 * plan.duration_s);
  }
}

TEST(Mission, ASpeedAtAnEndThatIsATurnInPlaceIsRefused) {
  MissionRequest mission{.name = "ends", .legs = {leg_along(kStraight, 0.0)}};
  mission.legs[0].end_speed_m_s = 0.3;
  EXPECT_LE(plan_of(mission).status, SolveStatus::feasible) << "it ends driving";
  const auto key_refused = [](const MissionRequest& asked) {
    try {
      static_cast<void>(plan_of(asked));
    } catch (const ConfigError& error) {
      return error.detail().key;
    }
    return std::string();
  };
  Path path;
  path.pieces.push_back(straight_piece({}, 2.0));
  append_turn_to(path, {}, 1.0);
  mission.legs[0].path = PathRequest{.ready = path};
  EXPECT_EQ(key_refused(mission), "end_speed_m_s");
  mission.legs[0].path = PathRequest{.bezier_m = {{{{0, 0}, {0, 1}, {0, 2}, {0, 3}}}}};  // begins with a turn
  EXPECT_EQ(key_refused(mission), "");
  mission.legs[0].start_speed_m_s = 0.3;
  EXPECT_EQ(key_refused(mission), "start_speed_m_s");
}

TEST(Mission, AnImpossibleDeadlineIsRefusedAndItsRelaxationWorks) {
  MissionRequest mission = two_legs();
  mission.objective.deadline_s = 12.0;
  const Plan plan = plan_of(mission);
  ASSERT_EQ(plan.status, SolveStatus::infeasible);
  ASSERT_TRUE(plan.infeasibility);
  EXPECT_EQ(plan.infeasibility->reason.constraint, "deadline");
  EXPECT_EQ(plan.infeasibility->leg, 1u);
  EXPECT_GT(plan.infeasibility->reason.amount, 0.0);
  mission.objective.deadline_s = plan.infeasibility->reason.relaxation.at("deadline_s") + 1e-6;
  EXPECT_NE(plan_of(mission).status, SolveStatus::infeasible);
}

TEST(Mission, ALateArrivalNamesTheDwellAndWhereADeadlineCountsFrom) {
  const auto message = [](double dwell_s, std::optional<double> of_leg_s,
                          std::optional<double> of_mission_s) {
    MissionRequest mission = two_legs();
    mission.legs[0].dwell_s = dwell_s;
    mission.legs[1].deadline_s = of_leg_s;
    mission.objective.deadline_s = of_mission_s;
    return lone_plan_of(mission).message;
  };
  EXPECT_NE(message(2000, {}, 90).find("2000.000 s of its time are dwell"), std::string::npos);
  EXPECT_NE(message(3, {}, 2).find("3.000 s of its time are dwell"),
            std::string::npos);  // late without it, too
  EXPECT_EQ(message(0, {}, 5).find("dwell"), std::string::npos);
  EXPECT_NE(message(0, 5, {}).find("counted from the mission's start"), std::string::npos);
  EXPECT_EQ(message(0, {}, 5).find("counted from"), std::string::npos);
}

TEST(Mission, AnEarlyDeadlineOfOneLegBindsThatLegAlone) {
  MissionRequest mission = two_legs();
  const Plan base = plan_of(mission);
  mission.legs[0].deadline_s = 0.9 * base.legs[0].duration_s;
  const Plan plan = plan_of(mission);
  EXPECT_NEAR(plan.legs[0].duration_s, *mission.legs[0].deadline_s, 1e-5);
  EXPECT_NEAR(plan.legs[1].duration_s, base.legs[1].duration_s, 1e-4);
  EXPECT_EQ(plan.legs[1].price_of_time_W, 0.0);
}

TEST(Mission, BaselinesAddUpOverTheLegs) {
  const Plan plan = plan_of(two_legs());
  ASSERT_EQ(plan.legs.size(), 2u) << plan.message;
  ASSERT_FALSE(plan.baselines.empty());
  for (std::size_t b = 0; b < plan.baselines.size(); ++b) {
    const BaselineTotal &first = plan.legs[0].baselines[b], &second = plan.legs[1].baselines[b],
                        &total = plan.baselines[b];
    EXPECT_GT(first.motion_energy_J, 0) << total.name;
    EXPECT_NEAR(total.motion_energy_J, first.motion_energy_J + second.motion_energy_J, 1e-9) << total.name;
    EXPECT_NEAR(total.energy_J, first.energy_J + second.energy_J, 1e-9) << total.name;
    EXPECT_NEAR(total.duration_s, first.duration_s + second.duration_s + 5.0, 1e-9) << total.name;
  }
}

TEST(Mission, DurationOfALegIsKeptShortOrLong) {
  const double free_s = plan_of(two_legs()).legs[0].duration_s;
  for (double factor : {0.9, 1.2, 5.0}) {
    MissionRequest mission = two_legs();
    mission.legs[0].duration_s = factor * free_s;
    const Plan plan = plan_of(mission);
    ASSERT_EQ(plan.legs.size(), 2u) << plan.message;
    EXPECT_NEAR(plan.legs[0].duration_s, factor * free_s, 1e-4 * free_s) << factor;
    EXPECT_LT(plan.legs[0].gap_percent, 0.1) << factor << ": standby while the robot waits is no gap";
  }
}

/// Energies, bounds and times of stretches add up to those of their leg, those of legs to the plan's; waits
/// within a leg count everywhere, in the battery's loss, too.
TEST(Mission, PartsAddUpToTheWhole) {
  const double free_s = lone_plan_of(two_legs()).legs[0].duration_s;
  for (const double factor : {0.95, 6.0}) {
    MissionRequest mission = two_legs();
    mission.legs[0].duration_s = factor * free_s;
    const Robot robot = patient_nomad();
    const Plan plan = lone_plan_of(mission, robot);
    ASSERT_EQ(plan.legs.size(), 2u) << plan.message;
    const double standby_W = robot.power.standby_W;
    double all_J = 0, all_bound_J = 0, all_s = 0, driving_loss_J = 0, resting_s = 0;
    for (const LegPlan& leg : plan.legs) {
      double sum_J = standby_W * leg.dwell_s, bound_J = sum_J, sum_s = 0;
      for (const StretchPlan& stretch : leg.stretches) {
        sum_J += stretch.energy.total_J();
        bound_J += stretch.summary.lower_bound_J;
        sum_s += stretch.profile.duration_s();
        driving_loss_J += stretch.battery_loss_J;
        resting_s += stretch.profile.wait_s;
        EXPECT_LE(stretch.summary.lower_bound_J, stretch.energy.total_J());
        EXPECT_NEAR(stretch.replay.energy_J, stretch.energy.total_J(), 1e-5 * sum_J);
      }
      EXPECT_NEAR(sum_J, leg.energy.total_J(), 1e-9 * sum_J) << factor;
      EXPECT_NEAR(bound_J, leg.lower_bound_J, 1e-9 * sum_J) << factor;
      EXPECT_NEAR(sum_s, leg.duration_s, 1e-9 * sum_s) << factor;
      all_J += sum_J, all_bound_J += bound_J, all_s += sum_s + leg.dwell_s, resting_s += leg.dwell_s;
    }
    EXPECT_NEAR(all_J, plan.energy.total_J(), 1e-9 * all_J);
    EXPECT_NEAR(all_bound_J, plan.lower_bound_J, 1e-9 * all_J);
    EXPECT_NEAR(all_s, plan.duration_s, 1e-9 * all_s);
    const double resting_W = battery_load(robot.battery, standby_W).loss_W;
    EXPECT_NEAR(driving_loss_J + resting_W * resting_s, plan.battery->loss_J, 1e-9 * plan.battery->loss_J);
  }
}

/// Only viscous friction: the speed of least energy in a given time is a constant less a cosh, and
/// E = A L^2 / (T - 2/k tanh(k T/2)) with A = b + R b^2/K^2 per wheel (angle L/r), C = R J^2/K^2,
/// k = sqrt(A/C), K = torque constant times gear ratio.
TEST(Mission, OnlyViscousFrictionTakesTheClosedFormsEnergyInAGivenTime) {
  Robot robot = testing::nomad();
  robot.power = {.standby_W = 0, .regeneration_efficiency = 1};
  for (const Side side : kSides) {
    robot.motor[side].friction_torque_Nm = 0;
    robot.motor[side].viscous_friction_Nm_s_rad = 0.039;
  }
  const Motor& motor = robot.motor.left;
  const Inertia& inertia = robot.inertia;
  const double radius_m = robot.geometry.wheel_radius_m.left;
  const double mass_kg = inertia.chassis_mass_kg + 2 * inertia.wheel_mass_kg;
  const double wheel_kg_m2 = 0.5 * mass_kg * radius_m * radius_m + inertia.wheel_axle_inertia_kg_m2;
  const double gain = motor.resistance_ohm / std::pow(motor.torque_constant_Nm_A * motor.gear_ratio, 2);
  const double b = motor.viscous_friction_Nm_s_rad;
  const double A = b + gain * b * b, C = gain * wheel_kg_m2 * wheel_kg_m2, k = std::sqrt(A / C);
  MissionRequest mission{.name = "viscous", .legs = {leg_along(kStraight, 0.0)}};
  EXPECT_THROW(lone_plan_of(mission, robot), ConfigError);
  for (const double time_s : {20.0, 30.0, 60.0}) {
    const double angle_rad = 6 / radius_m;
    const double exact_J = 2 * A * angle_rad * angle_rad / (time_s - 2 / k * std::tanh(0.5 * k * time_s));
    mission.objective.deadline_s = time_s;
    const Plan by_deadline = lone_plan_of(mission, robot);
    ASSERT_LE(by_deadline.status, SolveStatus::feasible) << by_deadline.message;
    EXPECT_NEAR(by_deadline.energy.total_J(), exact_J, 2e-4 * exact_J) << time_s;
    EXPECT_NEAR(by_deadline.duration_s, time_s, 1e-5 * time_s);
    EXPECT_NEAR(by_deadline.legs[0].price_of_time_W, exact_J / time_s, 0.3 * exact_J / time_s);
    MissionRequest by_duration{.name = "viscous", .legs = mission.legs};
    by_duration.legs[0].duration_s = time_s;
    EXPECT_NEAR(lone_plan_of(by_duration, robot).energy.total_J(), exact_J, 2e-4 * exact_J) << time_s;
  }
}

/// A deadline of the last leg bounds all of them; one of the first leaves the last one open.
TEST(Mission, WhereSlowerIsAlwaysCheaperEveryLegNeedsATime) {
  Robot robot = testing::nomad();
  robot.power.standby_W = 0;
  for (const Side side : kSides) {
    robot.motor[side].friction_torque_Nm = 0;
    robot.motor[side].viscous_friction_Nm_s_rad = 0.039;
  }
  MissionRequest mission{.name = "two", .legs = {leg_along(kStraight, 0.0), leg_along(kStraight, 2.0)}};
  mission.legs[0].deadline_s = 20;
  try {
    (void)lone_plan_of(mission, robot);
    ADD_FAILURE() << "the last leg has no time";
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.detail().key, "power.standby_W");
    EXPECT_NE(error.detail().found.find("legs[1]"), std::string::npos) << error.what();
  }
  mission.legs[1].deadline_s = 45;
  const Plan plan = lone_plan_of(mission, robot);
  ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
  EXPECT_NEAR(plan.duration_s, 45, 1e-3);
  mission.legs[0].deadline_s.reset();
  const Plan shared = lone_plan_of(mission, robot);
  EXPECT_LE(shared.energy.total_J(), plan.energy.total_J() * (1 + 1e-6));
  EXPECT_NEAR(shared.legs[0].price_of_time_W, shared.legs[1].price_of_time_W,
              1e-3 * shared.legs[0].price_of_time_W);
}

/// Without standby a second costs nothing, and the price at which the robot waits is zero.
TEST(Mission, ALegThatWaitsWithoutStandbyIsCertifiedAtNoPrice) {
  Robot robot = patient_nomad();
  robot.power.standby_W = 0.0;
  MissionRequest mission = two_legs();
  mission.legs[0].duration_s = 100.0;
  for (SolverChoice solver : {SolverChoice::fast, SolverChoice::ipopt}) {
    const Plan plan = plan_mission(mission, {.robot = robot}, {.solver = solver, .nodes = 60});
    ASSERT_EQ(plan.legs.size(), 2u) << plan.message;
    EXPECT_NEAR(plan.legs[0].duration_s, 100.0, 1e-9);
    EXPECT_GT(plan.legs[0].stretches.back().profile.wait_s, 50.0);
    EXPECT_EQ(plan.legs[0].price_of_time_W, 0.0);
    EXPECT_EQ(plan.legs[0].status, SolveStatus::optimal);
  }
}

TEST(LegTiming, KeepsTheTimeThatItIsGivenAtNoPriceOfASecondOrLess) {
  for (double standby_W : {0.0, 1.0}) {
    Robot robot = patient_nomad();
    robot.power.standby_W = standby_W;
    LegTiming timing({{.piece = straight_piece({}, 6.0),
                       .plant = make_plant(robot),
                       .limits = *robot.limits,
                       .nodes = 60}});
    for (double price_W : {0.0, -0.5 * standby_W}) {
      timing.give(kNoLimit);
      const double given_s = 0.9 * timing.duration_s(price_W, SolverChoice::fast);
      timing.give(given_s);
      EXPECT_NEAR(timing.duration_s(price_W, SolverChoice::fast), given_s, 1e-6 * given_s) << price_W;
    }
  }
}

TEST(Mission, TrajectoryIsUniformEndsAtTheEndAndIntegratesToTheSameEnergy) {
  const Robot robot = patient_nomad();
  const Plan plan = plan_of(two_legs(), robot);
  const Trajectory trajectory = plan_trajectory(plan, make_plant(robot));
  for (std::size_t k = 1; k + 1 < trajectory.size(); ++k)
    EXPECT_NEAR(trajectory.time_s[k] - trajectory.time_s[k - 1], 0.02, 1e-9);
  EXPECT_NEAR(trajectory.time_s.back(), plan.duration_s, 1e-9);
  EXPECT_NEAR(trajectory.energy_J.back(), plan.energy.total_J(), 2e-3 * plan.energy.total_J());
  EXPECT_NEAR(trajectory.position_x_m.back(), 2.7, 1e-6);
  EXPECT_NEAR(trajectory.position_y_m.back(), 8.7, 1e-6);
}

TEST(Mission, TooHeavyAPayloadIsAVerdict) {
  MissionRequest mission = two_legs();
  mission.legs[1].payload = {20, 20};
  const Plan plan = plan_of(mission);
  ASSERT_TRUE(plan.infeasibility);
  EXPECT_EQ(plan.infeasibility->reason.constraint, "max_payload");
  EXPECT_NEAR(plan.infeasibility->reason.amount, 8.0, 1e-12);
}

TEST(Mission, AnEmptyBatteryIsFoundBeforeTheDrive) {
  MissionRequest mission = two_legs();
  mission.start.battery_fraction = 0.1 + 1e-4;
  const Plan plan = plan_of(mission);
  ASSERT_TRUE(plan.infeasibility);
  EXPECT_EQ(plan.infeasibility->reason.constraint, "battery_reserve");
  mission.start.battery_fraction = plan.infeasibility->reason.relaxation.at("battery_fraction");
  EXPECT_FALSE(plan_of(mission).infeasibility);
}

/// A full battery that is too small: no charge above 1 is offered, but the capacity that is enough.
TEST(Mission, ABatteryThatIsTooSmallWhenFullIsToldTheCapacity) {
  Robot robot = patient_nomad();
  for (const double start : {1.0, 0.3}) {
    robot.battery.capacity_Wh = 0.02;
    MissionRequest mission = two_legs();
    mission.start.battery_fraction = start;
    const Plan plan = lone_plan_of(mission, robot);
    ASSERT_TRUE(plan.infeasibility);
    const auto& offered = plan.infeasibility->reason.relaxation;
    ASSERT_EQ(offered.size(), 1u);
    ASSERT_EQ(offered.begin()->first, "capacity_Wh");
    robot.battery.capacity_Wh = offered.begin()->second;
    EXPECT_FALSE(lone_plan_of(mission, robot).infeasibility) << start;
    robot.battery.capacity_Wh *= 0.999;
    EXPECT_TRUE(lone_plan_of(mission, robot).infeasibility) << start;
  }
}

TEST(Mission, PrescribedMotionPassesThrough) {
  LegRequest leg{
      .motion = PrescribedMotion{
          .profile = MotionProfile::trapezoid, .acceleration_m_s2 = 0.25, .speed_m_s = 0.5, .distance_m = 5}};
  MissionRequest mission{.name = "prescribed", .legs = {leg}};
  const Plan plan = plan_of(mission);
  ASSERT_EQ(plan.legs.size(), 1u);
  EXPECT_NEAR(plan.duration_s, 5 / 0.5 + 0.5 / 0.25, 1e-9);
  EXPECT_NEAR(plan.energy.coulomb_friction_J, (0.3728 + 0.346) / 0.1 * 5, 1e-6);
}

TEST(Mission, PrescribedMotionThatTheRobotCannotDriveIsAVerdict) {
  LegRequest leg{.motion = PrescribedMotion{.profile = MotionProfile::trapezoid,
                                            .acceleration_m_s2 = 0.25,
                                            .speed_m_s = 3.0,
                                            .distance_m = 60}};
  const Plan plan = plan_of({.name = "too_fast", .legs = {leg}});
  ASSERT_TRUE(plan.infeasibility);
  EXPECT_EQ(plan.infeasibility->reason.constraint, "speed");
  EXPECT_NEAR(plan.infeasibility->reason.amount, 2.0, 1e-3);
}

TEST(Mission, SpeedMayNotJumpBetweenLegs) {
  MissionRequest mission = two_legs();
  mission.legs[0].dwell_s = 0.0;
  mission.legs[0].end_speed_m_s = 0.3;
  EXPECT_THROW(plan_of(mission), ConfigError);
  mission.legs[1].start_speed_m_s = 0.3;
  const Plan plan = plan_of(mission);
  ASSERT_EQ(plan.legs.size(), 2u) << plan.message;
  EXPECT_LE(plan.worst_violation, 1e-6);
  mission.legs[0].dwell_s = 1.0;
  EXPECT_THROW(plan_of(mission), ConfigError);
}

/// One mission has one answer: the front's most economical point is the plan, with its status word.
TEST(Mission, TheFrontEndsAtThePlan) {
  for (const double jerk_m_s3 : {kNoLimit, 0.6}) {
    Robot robot = testing::nomad();
    robot.limits->jerk_m_s3 = jerk_m_s3;
    const Plan plan = plan_of(two_legs(), robot);
    ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
    const Front front = energy_time_front(planned_stretches(plan), 3);
    ASSERT_EQ(front.points.size(), 3u);
    const FrontPoint cheapest = sum_of(front.points.back(), rest_of(plan));
    EXPECT_NEAR(cheapest.energy_J, plan.energy.total_J(), 2e-5 * plan.energy.total_J());
    EXPECT_NEAR(cheapest.duration_s, plan.duration_s, 2e-3 * plan.duration_s);
    EXPECT_EQ(cheapest.status(1e-4), plan.status);
    EXPECT_NEAR(cheapest.gap_percent(), plan.gap_percent, 1e-2 + 0.1 * plan.gap_percent);
  }
}

/// Each point of a front has its own bound: it holds at its own time, whatever the plan's bound is.
TEST(Mission, EveryPointOfAFrontHasItsOwnBound) {
  const Plan plan = lone_plan_of(two_legs());
  const Front front = energy_time_front(planned_stretches(plan), 6);
  ASSERT_EQ(front.points.size(), 6u);
  EXPECT_TRUE(std::isnan(front.points.front().gap_J)) << "the least time has a bound of the time";
  EXPECT_GE(front.points.front().gap_s, 0.0);
  std::set<double> gaps_percent;
  for (const FrontPoint& point : front.points) {
    EXPECT_GE(point.gap_percent(), 0.0);
    EXPECT_LT(point.gap_percent(), 1.0);
    gaps_percent.insert(point.gap_percent());
    EXPECT_EQ(point.status(1e-2), SolveStatus::optimal);
    EXPECT_EQ(point.status(0.0099 * point.gap_percent()), SolveStatus::feasible);
  }
  EXPECT_EQ(gaps_percent.size(), front.points.size()) << "a gap of its own";
  for (std::size_t k = 1; k < front.points.size(); ++k) {
    ProfileRequest request = planned_stretches(plan)[0].request;
    request.time = {.mode = TimeMode::fixed_time, .duration_s = front.points[k].stretch_s[0]};
    EXPECT_TRUE(solve_profile(request).profile) << k;
  }
}

/// Where slower is always cheaper the mission's time ends the front.
TEST(Mission, AFrontEndsAtThePriceOfItsMissionWhereSlowerIsAlwaysCheaper) {
  Robot robot = testing::nomad();
  robot.power.standby_W = 0;
  for (const Side side : kSides) {
    robot.motor[side].friction_torque_Nm = 0;
    robot.motor[side].viscous_friction_Nm_s_rad = 0.05;
  }
  MissionRequest mission{.name = "viscous"};
  mission.legs = {{.path = PathRequest{.bezier_m = {{{{0, 0}, {1.5, 0}, {2.7, 1.2}, {2.7, 2.7}}}}}}};
  mission.objective.deadline_s = 20;
  const Plan plan = lone_plan_of(mission, robot);
  ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
  ASSERT_GT(planned_price_W(plan), 0.0);
  const Front front = energy_time_front(planned_stretches(plan), 5, planned_price_W(plan));
  ASSERT_EQ(front.points.size(), 5u) << front.summary.message;
  EXPECT_NEAR(front.points.back().duration_s, 20, 1e-2);
  EXPECT_NEAR(front.points.back().energy_J, plan.energy.total_J(), 1e-3 * plan.energy.total_J());
}

/// The samples of a prescribed motion are bounded, its energy and time stay exact.
TEST(Mission, ALongPrescribedMotionHasBoundedSamples) {
  const auto stand = [](double duration_s) {
    PrescribedMotion motion{.profile = MotionProfile::stand};
    motion.duration_s = duration_s;
    return motion;
  };
  const auto spin = [](double angle_rad) {
    PrescribedMotion motion{.profile = MotionProfile::spin};
    motion.angle_rad = angle_rad, motion.yaw_rate_rad_s = 0.5;
    return motion;
  };
  Robot robot = testing::nomad();
  robot.power.standby_W = 10;
  robot.battery.capacity_Wh = 1e6;
  const auto planned = [&](const PrescribedMotion& motion) {
    MissionRequest mission{.name = "prescribed"};
    mission.legs = {{.motion = motion}};
    return lone_plan_of(mission, robot);
  };
  for (const double duration_s : {10.0, 1e5, 1e6}) {
    const Plan plan = planned(stand(duration_s));
    ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
    EXPECT_LE(plan.legs[0].prescribed->size(), 30000u);
    EXPECT_NEAR(plan.duration_s, duration_s, 1e-9 * duration_s);
    EXPECT_NEAR(plan.energy.total_J(), 10 * duration_s, 1e-6 * duration_s);
  }
  const Plan few = planned(spin(100)), many = planned(spin(10000));
  EXPECT_LE(many.legs[0].prescribed->size(), 30000u);
  EXPECT_NEAR(many.duration_s - few.duration_s, 9900 / 0.5, 1e-6);
  const double a_turn_J = few.energy.total_J() / few.duration_s;
  EXPECT_NEAR(many.energy.total_J() / many.duration_s, a_turn_J, 0.01 * a_turn_J);
}

}  // namespace
}  // namespace joulepath
