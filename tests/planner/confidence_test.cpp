// Plans that keep their promises with a stated probability. Judges: closed forms, and robots drawn here and
// driven along the rows of the plan.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "model/config_error.hpp"
#include "model/operating_point.hpp"
#include "planner/accounts/plan_trajectory.hpp"
#include "planner/confidence/lateness.hpp"
#include "planner/confidence/margins.hpp"
#include "planner/mission/mission.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// A robot whose motors' current is all that limits it, and that recovers nothing.
Robot weak_robot() {
  Robot robot = testing::nomad();
  robot.limits = Limits{.max_payload_kg = 12};
  for (const Side side : kSides) {
    robot.motor[side].max_voltage_V = 1000;
    robot.motor[side].max_current_A = 1.0;
    robot.motor[side].viscous_friction_Nm_s_rad = 0;
    robot.motor[side].friction_torque_Nm = 0.35;
  }
  robot.uncertainty = {{"chassis_mass_kg", 0.08}, {"model_energy", 0.0}};
  return robot;
}

MissionRequest straight(double length_m, Objective objective) {
  MissionRequest mission{.name = "straight", .objective = std::move(objective)};
  const double third = length_m / 3;
  mission.legs.push_back(
      {.path = PathRequest{.bezier_m = {{{{0, 0}, {third, 0}, {2 * third, 0}, {length_m, 0}}}}}});
  return mission;
}

Objective soonest(double confidence) {
  return {.minimize = Objective::Minimize::time, .confidence = confidence};
}

Plan planned(const MissionRequest& mission, const Robot& robot) {
  return plan_mission(mission, {.robot = robot},
                      {.solver = SolverChoice::fast, .nodes = 60, .baselines = false});
}

double normal_share(double sigmas) { return 0.5 * std::erfc(-sigmas / std::sqrt(2.0)); }

/// Standard deviation of a share of so many draws.
double share_sigma(double share, double draws) { return std::sqrt(share * (1 - share) / draws); }

double greatest_current_A(const Trajectory& rows) {
  double most_A = 0;
  for (const Side side : kSides)
    for (const double current_A : rows.motor_current_A[side]) most_A = std::max(most_A, std::abs(current_A));
  return most_A;
}

/// |i| = (r F/2 + J a/r - T_m)/(Kt n) with F = m a while braking at a, where friction helps and a is
/// greatest: the mass that takes the greatest current is known, so is the probability of a smaller one.
TEST(Confidence, OfAMassAtTheCurrentLimitIsItsNormalQuantile) {
  for (const double confidence : {0.8, 0.95, 0.99}) {
    const Robot robot = weak_robot();
    const Plan plan = planned(straight(6, soonest(confidence)), robot);
    ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
    const Motor& motor = robot.motor.left;
    const double r = robot.geometry.wheel_radius_m.left, kt = motor.torque_constant_Nm_A * motor.gear_ratio;
    const double used_A = greatest_current_A(plan_trajectory(plan, make_plant(robot), 200));
    const double per_acceleration =
        0.5 * r * robot.total_mass_kg(0) + robot.inertia.wheel_axle_inertia_kg_m2 / r;
    const double a = (used_A * kt + motor.friction_torque_Nm) / per_acceleration;
    const double sigma_A = 0.5 * r * 0.08 * robot.inertia.chassis_mass_kg * a / kt;
    const double kept = normal_share((motor.max_current_A - used_A) / sigma_A);
    ASSERT_TRUE(plan.confidence);
    const auto draws = static_cast<double>(plan.confidence->draws);
    EXPECT_NEAR(plan.confidence->kept, kept, 4 * share_sigma(kept, draws)) << confidence;
    EXPECT_GE(kept, confidence);
    EXPECT_LE(kept, confidence + 8 * share_sigma(confidence, draws)) << "more margin than asked for";
    EXPECT_GE(plan.confidence->kept_at_least, confidence);
    EXPECT_NEAR(plan.confidence->kept_without, 0.5, 0.05);
  }
}

/// Robots drawn here, moved along the rows of the plan with the operating point of each.
double share_kept(const Plan& plan, const Robot& robot, int draws) {
  const Trajectory rows = plan_trajectory(plan, make_plant(robot), 150);
  std::mt19937_64 random(977);
  std::normal_distribution<double> normal;
  int kept = 0;
  for (int i = 0; i < draws; ++i) {
    Robot drawn = robot;
    drawn.inertia.chassis_mass_kg *= 1 + 0.05 * normal(random);
    const double warmer = 1 + 0.1 * normal(random);
    for (const Side side : kSides) {
      drawn.motor[side].friction_torque_Nm *= 1 + 0.15 * normal(random);
      drawn.motor[side].resistance_ohm *= warmer;
    }
    const Plant plant = make_nominal_plant(drawn);
    bool holds = true;
    for (std::size_t k = 0; k + 1 < rows.size() && holds; ++k) {
      const double dt = rows.time_s[k + 1] - rows.time_s[k];
      if (dt <= 0) continue;
      const auto slope = [&](const std::vector<double>& values) { return (values[k + 1] - values[k]) / dt; };
      const auto middle = [&](const std::vector<double>& values) {
        return 0.5 * (values[k] + values[k + 1]);
      };
      const BodyMotion<double> motion{middle(rows.linear_speed_m_s), slope(rows.linear_speed_m_s),
                                      middle(rows.angular_speed_rad_s), slope(rows.angular_speed_rad_s)};
      Site site{.payload_kg = rows.payload_kg[k]};
      for (const Side side : kSides)
        site.wheel_direction[side] =
            sign_of(motion.speed_m_s + (side == Side::left ? -1 : 1) * 0.165 * motion.yaw_rate_rad_s);
      const auto wheels = operating_point(plant, motion, site);
      for (const Side side : kSides)
        holds &= std::abs(wheels[side].current_A) <= robot.motor[side].max_current_A &&
                 std::abs(wheels[side].voltage_V) <= robot.motor[side].max_voltage_V;
    }
    kept += holds ? 1 : 0;
  }
  return static_cast<double>(kept) / draws;
}

/// Two limits bind at different places of two legs, one of them a bend with a deadline.
TEST(Confidence, IsThatOfRobotsDrawnElsewhere) {
  Robot robot = testing::nomad();
  for (const Side side : kSides) robot.motor[side].max_voltage_V = 14, robot.motor[side].max_current_A = 1.35;
  robot.limits->acceleration_m_s2 = robot.limits->deceleration_m_s2 = 3;
  robot.limits->lateral_acceleration_m_s2 = 3;
  robot.uncertainty = {{"chassis_mass_kg", 0.05},
                       {"friction_torque_Nm", 0.15},
                       {"resistance_ohm", 0.1},
                       {"model_energy", 0.0}};
  MissionRequest mission = straight(5, soonest(0.95));
  mission.legs.push_back(
      {.path = PathRequest{.bezier_m = {{{{0, 0}, {2, 0}, {4, 1}, {4, 3}}}}}, .payload = {6, 6}});
  const Plan plan = planned(mission, robot);
  ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
  ASSERT_TRUE(plan.confidence);
  EXPECT_GE(plan.confidence->limit_shares.size(), 2u);
  const double share = share_kept(plan, robot, 1500);
  EXPECT_NEAR(share, plan.confidence->kept, 4 * share_sigma(0.95, 1500));
  EXPECT_LT(plan.confidence->kept_without, 0.6);
  EXPECT_GT(plan.duration_s, plan.confidence->duration_without_s);
}

TEST(Confidence, MoreOfItIsNeverFaster) {
  double before_s = 0;
  for (const double confidence : {0.6, 0.9, 0.99}) {
    const Plan plan = planned(straight(6, soonest(confidence)), weak_robot());
    ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
    EXPECT_GT(plan.duration_s, before_s);
    before_s = plan.duration_s;
  }
}

/// Errors of zero change nothing, and all promises are kept.
TEST(Confidence, OfExactConstantsChangesNothing) {
  Robot robot = weak_robot();
  robot.uncertainty = {{"chassis_mass_kg", 0.0}, {"model_energy", 0.0}};
  Objective objective = soonest(0.95);
  const Plan sure = planned(straight(6, objective), robot);
  objective.confidence.reset();
  const Plan plain = planned(straight(6, objective), robot);
  ASSERT_TRUE(sure.confidence);
  EXPECT_EQ(sure.confidence->kept, 1.0);
  EXPECT_EQ(sure.energy.total_J(), plain.energy.total_J());
  EXPECT_EQ(sure.legs[0].stretches[0].profile.rate, plain.legs[0].stretches[0].profile.rate);
}

TEST(Confidence, NeedsTheErrorsOfTheRobot) {
  for (const std::string key : {"uncertainty", "uncertainty.model_energy"}) {
    Robot robot = weak_robot();
    robot.uncertainty.erase("model_energy");
    if (key == "uncertainty") robot.uncertainty.clear();
    try {
      (void)planned(straight(6, soonest(0.95)), robot);
      FAIL() << "planned without " << key;
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find(key), std::string::npos) << error.what();
    }
  }
}

/// A deadline that only a plan without margins keeps: the verdict says by how much it is too early.
TEST(Confidence, AVerdictSaysWhatDeadlineIsKept) {
  const Plan fastest = planned(straight(6, {.minimize = Objective::Minimize::time}), weak_robot());
  const Objective tight{.deadline_s = 1.01 * fastest.duration_s, .confidence = 0.95};
  const Plan refused = planned(straight(6, tight), weak_robot());
  ASSERT_EQ(refused.status, SolveStatus::infeasible);
  EXPECT_NE(refused.message.find("with 95 %"), std::string::npos) << refused.message;
  ASSERT_TRUE(refused.confidence);
  EXPECT_LT(refused.confidence->kept_without, 0.95);
  Objective later = tight;
  later.deadline_s = *tight.deadline_s + refused.infeasibility->reason.amount + 1e-6;
  const Plan kept = planned(straight(6, later), weak_robot());
  ASSERT_LE(kept.status, SolveStatus::feasible) << kept.message;
  EXPECT_GE(kept.confidence->kept_at_least, 0.95);
}

/// The energy of a charge is E (1 + sigma z) on a robot whose only error is the model's.
TEST(Confidence, GuardsTheReserveByTheModelsOwnError) {
  Robot robot = testing::nomad();
  robot.uncertainty = {{"model_energy", 0.04}};
  robot.battery.internal_resistance_ohm = 0;
  robot.power.standby_W = 1;
  const Plan free = planned(straight(6, {}), robot);
  const double needed_Wh = free.energy.total_J() / 3600;
  const double sigma_Wh = 0.04 * free.energy.motion_J() / 3600;
  const auto with_capacity = [&](double sigmas) {
    Robot other = robot;
    other.battery.capacity_Wh = (needed_Wh + sigmas * sigma_Wh) / (1 - robot.battery.reserve_fraction);
    return planned(straight(6, {.confidence = 0.95}), other);
  };
  const Plan enough = with_capacity(1.9);
  ASSERT_LE(enough.status, SolveStatus::feasible) << enough.message;
  EXPECT_NEAR(enough.confidence->kept, normal_share(1.9), 4 * share_sigma(0.95, 4000));
  const Plan too_small = with_capacity(1.4);
  ASSERT_EQ(too_small.status, SolveStatus::infeasible);
  EXPECT_EQ(too_small.infeasibility->reason.constraint, "battery_reserve");
  EXPECT_NEAR(too_small.confidence->kept_without, normal_share(1.4), 4 * share_sigma(0.92, 4000));
}

/// From rest at a constant current: a robot that is heavier than planned reaches the speed later, by
/// v/2 (1/a - 1/a_planned).
TEST(Lateness, OfAHeavierRobotIsThatOfItsSlowerStart) {
  Robot robot = weak_robot();
  robot.limits->speed_m_s = 0.5;
  robot.limits->deceleration_m_s2 = 0.2;
  const Plan plan = planned(straight(6, {.minimize = Objective::Minimize::time}), robot);
  ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
  Robot heavy = robot;
  heavy.inertia.chassis_mass_kg *= 1.3;
  const auto acceleration = [](const Robot& r) {
    const Motor& motor = r.motor.left;
    const double R = r.geometry.wheel_radius_m.left;
    return (motor.max_current_A * motor.torque_constant_Nm_A * motor.gear_ratio - motor.friction_torque_Nm) /
           (0.5 * R * r.total_mass_kg(0) + r.inertia.wheel_axle_inertia_kg_m2 / R);
  };
  const double expected_s = 0.25 * (1 / acceleration(heavy) - 1 / acceleration(robot));
  const StretchPlan& stretch = plan.legs[0].stretches[0];
  EXPECT_NEAR(lateness_s(stretch, make_plant(heavy), *robot.limits), expected_s, 0.03 * expected_s);
  EXPECT_NEAR(lateness_s(stretch, make_plant(robot), *robot.limits), 0, 1e-6);
}

TEST(Margins, AreShownByTheBinomialTail) {
  EXPECT_TRUE(is_shown(962, 1000, 0.95));
  EXPECT_FALSE(is_shown(961, 1000, 0.95));
  EXPECT_NEAR(kept_at_least(59, 59), std::pow(0.05, 1.0 / 59), 1e-6);
  EXPECT_EQ(kept_at_least(0, 10), 0.0);
}

}  // namespace
}  // namespace joulepath
