// Plans that keep their promises with a stated probability. Judges: closed forms, and robots drawn here and
// driven along the rows of the plan.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <regex>
#include <utility>

#include "model/config_error.hpp"
#include "planner/accounts/battery_account.hpp"
#include "planner/accounts/plan_trajectory.hpp"
#include "planner/accounts/state_offers.hpp"
#include "planner/cache/answer_cache.hpp"
#include "planner/confidence/lateness.hpp"
#include "planner/confidence/margins.hpp"
#include "planner/confidence/plan_demands.hpp"
#include "planner/mission/mission.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/tug.hpp"

namespace joulepath {
namespace {

using testing::tow;

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

Plan planned_for(const MissionRequest& mission, const Robot& robot) {
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
    const Plan plan = planned_for(straight(6, soonest(confidence)), robot);
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

/// Newton's law for one wheel, written out: side -1 is the left one.
struct WheelJudge {
  double chassis_kg, friction_Nm, ohm;
  int side;

  bool holds(const Robot& robot, double payload_kg, const BodyMotion<double>& body) const {
    const double l = robot.geometry.half_track_m, r = robot.geometry.wheel_radius_m.left;
    const Inertia& in = robot.inertia;
    const double mass = chassis_kg + 2 * in.wheel_mass_kg + payload_kg;
    const double inertia = in.chassis_yaw_inertia_kg_m2 + in.payload_yaw_inertia_m2 * payload_kg +
                           2 * (in.wheel_mass_kg * l * l + in.wheel_diameter_inertia_kg_m2);
    const double speed = (body.speed_m_s + side * l * body.yaw_rate_rad_s) / r;
    const double gain = (body.acceleration_m_s2 + side * l * body.yaw_acceleration_rad_s2) / r;
    const Motor& motor = robot.motor.left;
    const double torque =
        r * (0.5 * mass * body.acceleration_m_s2 + side * 0.5 * inertia * body.yaw_acceleration_rad_s2 / l) +
        in.wheel_axle_inertia_kg_m2 * gain + motor.viscous_friction_Nm_s_rad * speed +
        std::copysign(friction_Nm, speed);
    const double per_A = motor.torque_constant_Nm_A * motor.gear_ratio, current_A = torque / per_A;
    return std::abs(current_A) <= motor.max_current_A &&
           std::abs(ohm * current_A + per_A * speed) <= motor.max_voltage_V;
  }
};

/// Robots drawn here, moved along the rows of the plan.
double share_kept(const Plan& plan, const Robot& robot, int draws) {
  const Trajectory rows = plan_trajectory(plan, make_plant(robot), 150);
  std::mt19937_64 random(977);
  std::normal_distribution<double> normal;
  int kept = 0;
  for (int i = 0; i < draws; ++i) {
    const double chassis_kg = robot.inertia.chassis_mass_kg * (1 + 0.05 * normal(random)),
                 ohm = robot.motor.left.resistance_ohm * (1 + 0.1 * normal(random));
    std::array<WheelJudge, 2> wheels;
    for (const Side side : kSides)
      wheels[side == Side::left ? 0 : 1] = {
          chassis_kg, robot.motor[side].friction_torque_Nm * (1 + 0.15 * normal(random)), ohm,
          side == Side::left ? -1 : 1};
    bool holds = true;
    for (std::size_t k = 0; k + 1 < rows.size() && holds; ++k) {
      const double dt = rows.time_s[k + 1] - rows.time_s[k];
      if (dt <= 0) continue;
      const auto slope = [&](const std::vector<double>& values) { return (values[k + 1] - values[k]) / dt; };
      const auto middle = [&](const std::vector<double>& values) {
        return 0.5 * (values[k] + values[k + 1]);
      };
      const BodyMotion<double> body{middle(rows.linear_speed_m_s), slope(rows.linear_speed_m_s),
                                    middle(rows.angular_speed_rad_s), slope(rows.angular_speed_rad_s)};
      for (const WheelJudge& wheel : wheels) holds &= wheel.holds(robot, rows.payload_kg[k], body);
    }
    kept += holds ? 1 : 0;
  }
  return static_cast<double>(kept) / draws;
}

/// Two limits bind at different places of two legs, one of them a bend.
Robot uncertain_robot() {
  Robot robot = testing::nomad();
  for (const Side side : kSides) robot.motor[side].max_voltage_V = 14, robot.motor[side].max_current_A = 1.35;
  robot.limits->acceleration_m_s2 = robot.limits->deceleration_m_s2 = 3;
  robot.limits->lateral_acceleration_m_s2 = 3;
  robot.uncertainty = {{"chassis_mass_kg", 0.05},
                       {"friction_torque_Nm", 0.15},
                       {"resistance_ohm", 0.1},
                       {"model_energy", 0.0}};
  return robot;
}

MissionRequest straight_and_bend(Objective objective) {
  MissionRequest mission = straight(5, std::move(objective));
  mission.legs.push_back(
      {.path = PathRequest{.bezier_m = {{{{0, 0}, {2, 0}, {4, 1}, {4, 3}}}}}, .payload = {6, 6}});
  return mission;
}

TEST(Confidence, IsThatOfRobotsDrawnElsewhere) {
  const Robot robot = uncertain_robot();
  const Plan plan = planned_for(straight_and_bend(soonest(0.95)), robot);
  ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
  ASSERT_TRUE(plan.confidence);
  EXPECT_GE(plan.confidence->limit_shares.size(), 2u);
  const double share = share_kept(plan, robot, 1500);
  EXPECT_NEAR(share, plan.confidence->kept, 4 * share_sigma(0.95, 1500));
  EXPECT_LT(plan.confidence->kept_without, 0.6);
  EXPECT_GT(plan.duration_s, plan.confidence->duration_without_s);
}

/// A drawn robot's greatest uses are looked for at the places that derivatives name: they are those of all
/// places.
TEST(Confidence, LooksWhereADrawnRobotUsesItsLimitsMost) {
  Robot robot = uncertain_robot();
  robot.uncertainty["model_energy"] = 0.05;
  robot.uncertainty_correlations = {{"chassis_mass_kg", "resistance_ohm", -0.6}};
  const Plan plan = planned_for(straight_and_bend({.minimize = Objective::Minimize::time}), robot);
  const Plant plant = make_plant(robot);
  const PlanDemands demands(plan, robot, plant, {});
  PlantDraws draws(robot, plant, 7);
  const Eigen::MatrixXd errors = draws.next_errors(150);
  const std::vector<PlanDemand> found = demands.of(errors, draws), estimated = demands.estimate(errors);
  std::size_t saturated = 0;
  for (std::size_t draw = 0; draw < found.size(); ++draw) {
    const DrawnPlant drawn = demands.plant_of(draws.draw_of(errors.col(static_cast<Eigen::Index>(draw))));
    const ForceUses all = ForceDemands(plan, robot, drawn, {}).nominal();
    for (std::size_t i = 0; i < kForceLimits; ++i) {
      if (all[i] < 0.9) continue;
      EXPECT_NEAR(found[draw].use[i], all[i], 2e-5) << force_limits()[i]->name << " of draw " << draw;
      EXPECT_NEAR(estimated[draw].use[i], all[i], 0.03) << force_limits()[i]->name << " of draw " << draw;
      saturated += all[i] > 1;
    }
  }
  EXPECT_GT(saturated, 50u);
}

/// Robots whose errors act far from linearly: a weak motor constant, which counts squared in the power and in
/// the copper's losses, and a hill that nearly drives the robot, where the current changes its sign.
std::vector<Robot> bent_robots() {
  std::vector<Robot> robots(3, testing::nomad());
  for (Robot& robot : robots) robot.uncertainty_correlations.clear();
  robots[0].uncertainty = {{"torque_constant_Nm_A", 0.3}, {"gear_ratio", 0.2}, {"model_energy", 0.02}};
  robots[1].uncertainty = {{"friction_torque_Nm", 0.2}, {"chassis_mass_kg", 0.1}, {"model_energy", 0.05}};
  robots[1].effects = {
      {.name = "floor_slope", .parameters = {{"grade", 0.03}, {"uphill_direction_rad", M_PI}}}};
  robots[1].limits->acceleration_m_s2 = robots[1].limits->deceleration_m_s2 = 0.005;
  robots[1].geometry.center_of_mass_offset_m = 0;
  robots[2].uncertainty = {{"torque_constant_Nm_A", 0.3}, {"model_energy", 0.01}};
  for (const Side side : kSides) {
    robots[0].motor[side].max_current_A = 2.5;
    robots[1].motor[side].max_current_A = 0.1;
    robots[1].motor[side].friction_torque_Nm = 0.353;
    robots[2].motor[side].resistance_ohm = 20;
  }
  robots[2].battery.reserve_fraction = 0.1;
  robots[2].battery.capacity_Wh = 0.16;
  return robots;
}

/// Judge: the model at all places and over all of the motion, for each drawn robot.
TEST(Confidence, JudgesRobotsWhoseErrorsActFarFromLinearly) {
  for (const Robot& robot : bent_robots()) {
    const std::ptrdiff_t which = std::ssize(robot.effects);
    const Plan plan = planned_for(straight(3, {}), robot);
    ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
    const Plant plant = make_plant(robot);
    const PlanDemands demands(plan, robot, plant, {.start_fraction = 1.0});
    const PlanCourses courses(plan, plant, {.start_fraction = 1.0});
    PlantDraws draws(robot, plant, 11);
    const Eigen::MatrixXd errors = draws.next_errors(1000);
    const std::vector<PlanDemand> found = demands.of(errors, draws), estimated = demands.estimate(errors);
    int lost = 0, wrong = 0, estimated_wrong = 0;
    for (std::size_t draw = 0; draw < found.size(); ++draw) {
      const DrawnPlant drawn = demands.plant_of(draws.draw_of(errors.col(static_cast<Eigen::Index>(draw))));
      PlanDemand all{.least_fraction = courses.of(drawn.plant).least_fraction};
      const ForceUses uses = ForceDemands(plan, robot, drawn, {}).nominal();
      std::copy(uses.begin(), uses.end(), all.use.begin());
      const auto keeps = [&](const PlanDemand& demand) {
        return keeps_limits(demand) && keeps_reserve(demand, robot.battery.reserve_fraction);
      };
      lost += !keeps(all), wrong += keeps(all) != keeps(found[draw]);
      estimated_wrong += keeps(all) != keeps(estimated[draw]);
    }
    EXPECT_GT(lost, 5) << which << " effects, " << robot.battery.capacity_Wh << " Wh";
    if (which > 0) {  // |a + b x| is estimated on both sides
      EXPECT_LT(estimated_wrong, 0.2 * lost) << lost << " lost";
    }
    EXPECT_LE(wrong, 3) << lost << " lost, " << which << " effects, " << robot.battery.capacity_Wh << " Wh";
  }
}

/// A later deadline is never refused where an earlier one is kept.
TEST(Confidence, ALaterDeadlineIsNeverRefused) {
  Robot robot = testing::nomad();
  for (const Side side : kSides) robot.motor[side].max_current_A = 0.95;
  robot.uncertainty_correlations.clear();
  robot.uncertainty = {{"friction_torque_Nm", 0.15},
                       {"chassis_mass_kg", 0.1},
                       {"resistance_ohm", 0.1},
                       {"torque_constant_Nm_A", 0.03},
                       {"model_energy", 0.02}};
  const Plan fastest = planned_for(straight_and_bend(soonest(0.95)), robot);
  ASSERT_LE(fastest.status, SolveStatus::feasible) << fastest.message;
  for (const double later : {1.0001, 1.0005, 1.001, 1.004, 1.008, 1.015, 1.03}) {
    const Objective objective{.deadline_s = later * fastest.duration_s, .confidence = 0.95};
    const Plan plan = planned_for(straight_and_bend(objective), robot);
    EXPECT_LE(plan.status, SolveStatus::feasible) << later << ": " << plan.message;
  }
}

/// Without its rolling resistance the robot needs more current to brake: a plan that uses the whole current
/// is kept by the robots that have it, one with margins by the others, too.
TEST(Confidence, MixesAnEffectByItsProbability) {
  Robot robot = weak_robot();
  robot.uncertainty = {{"chassis_mass_kg", 0.0}, {"model_energy", 0.0}};
  robot.effects = {{.name = "rolling_resistance", .parameters = {{"coefficient", 0.01}}, .probability = 0.7}};
  const Plan plan = planned_for(straight(6, soonest(0.95)), robot);
  ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
  EXPECT_NEAR(plan.confidence->kept_without, 0.7, 4 * share_sigma(0.7, 4000));
  EXPECT_EQ(plan.confidence->kept, 1.0);
  Robot lacking = robot;
  lacking.effects.clear();
  EXPECT_LE(greatest_current_A(plan_trajectory(plan, make_plant(lacking), 200)), 1.0 + 1e-6);
  robot.effects[0].probability = 0.99;  // more than is asked for
  const Plan sure = planned_for(straight(6, soonest(0.95)), robot);
  EXPECT_TRUE(sure.confidence->limit_shares.empty());
  EXPECT_LT(sure.duration_s, 0.99 * plan.duration_s);
}

/// The plant that lacks an effect is where the estimate of a lacking draw lies: on a place whose use grows by
/// more than half, too, where a force that changed its sign would give as much.
TEST(Confidence, EstimatesALackingEffectByThePlantWithoutIt) {
  Robot robot = weak_robot();
  robot.uncertainty = {{"chassis_mass_kg", 0.0}, {"model_energy", 0.0}};
  robot.effects = {{.name = "rolling_resistance", .parameters = {{"coefficient", 0.03}}, .probability = 0.7}};
  const Plan plan = planned_for(straight(6, {.minimize = Objective::Minimize::time}), robot);
  ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
  const Plant plant = make_plant(robot);
  const PlanDemands demands(plan, robot, plant, {.start_fraction = 1.0});
  PlantDraws draws(robot, plant, 3);
  Eigen::MatrixXd errors = draws.next_errors(1);
  errors.setZero();
  errors(errors.rows() - 1, 0) = kLacking;
  const Plant lacking = plant_without(robot, {0});
  const ForceUses without = ForceDemands(plan, robot, {lacking}, {}).nominal();
  const auto estimated = demands.estimate(errors)[0].use;
  bool grew = false;
  for (std::size_t i = 0; i < kForceLimits; ++i) {
    if (without[i] < 0.5) continue;  // far from every limit
    EXPECT_NEAR(estimated[i], without[i], 0.02 * without[i]) << force_limits()[i]->name;
    grew = grew || without[i] > 1.05 * demands.nominal().use[i];
  }
  EXPECT_TRUE(grew);
}

/// Both wheels' friction errs on its own. A start needs a per + T <= I Kt n, braking a per - T <= I Kt n,
/// each on both sides, and all of them use the same share of the current: so |dT| <= d on both, (2 Phi(z) -
/// 1)^2.
TEST(Confidence, OfFrictionIsThatOfTwoWheels) {
  Robot robot = weak_robot();
  robot.uncertainty = {{"friction_torque_Nm", 0.15}, {"model_energy", 0.0}};
  const Plan plan = planned_for(straight(6, soonest(0.95)), robot);
  ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
  const Motor& motor = robot.motor.left;
  const double used_A = greatest_current_A(plan_trajectory(plan, make_plant(robot), 200));
  const double spare_Nm = (motor.max_current_A - used_A) * motor.torque_constant_Nm_A * motor.gear_ratio;
  const double one_wheel = 2 * normal_share(spare_Nm / (0.15 * motor.friction_torque_Nm)) - 1;
  EXPECT_NEAR(plan.confidence->kept, one_wheel * one_wheel, 4 * share_sigma(0.95, 4000));
  EXPECT_GE(one_wheel * one_wheel, 0.95);
}

TEST(Confidence, IsNotPromisedForAModelThatMissesTooMuch) {
  Robot robot = weak_robot();
  robot.uncertainty = {{"chassis_mass_kg", 0.02}, {"model_energy", 0.3}};
  const Plan plan = planned_for(straight(6, soonest(0.95)), robot);
  EXPECT_EQ(plan.status, SolveStatus::failed);
  EXPECT_NE(plan.message.find("cannot promise 95 %: the model misses 30 % of the energy of motion ("),
            std::string::npos)
      << plan.message;
  const Plan late =
      planned_for(straight(6, {.deadline_s = 0.5 * plan.duration_s, .confidence = 0.95}), robot);
  EXPECT_EQ(late.status, SolveStatus::infeasible);
  EXPECT_EQ(late.infeasibility->reason.constraint, "deadline");
}

/// Near certainty a plan without margins is not taken for one that keeps its promises.
TEST(Confidence, NearOneIsMeasuredThere) {
  Robot robot = weak_robot();
  const Plan fastest = planned_for(straight(6, {.minimize = Objective::Minimize::time}), robot);
  const double used_A = greatest_current_A(plan_trajectory(fastest, make_plant(robot), 200));
  const Motor& motor = robot.motor.left;
  const double kt = motor.torque_constant_Nm_A * motor.gear_ratio;
  const double sigma = 0.08 * 0.5 * 0.1 * robot.inertia.chassis_mass_kg /
                       (0.05 * robot.total_mass_kg(0) + robot.inertia.wheel_axle_inertia_kg_m2 / 0.1);
  // The deceleration limit leaves 3.1 sigmas of current to the mass.
  const double torque_Nm = (used_A * kt + motor.friction_torque_Nm) / (1 + 3.1 * sigma);
  robot.limits->deceleration_m_s2 =
      torque_Nm / (0.05 * robot.total_mass_kg(0) + robot.inertia.wheel_axle_inertia_kg_m2 / 0.1);
  robot.limits->acceleration_m_s2 = 0.5 * robot.limits->deceleration_m_s2;
  const Plan plan = planned_for(straight(6, soonest(0.9995)), robot);
  ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
  EXPECT_NEAR(plan.confidence->kept_without, normal_share(3.1), 2e-4);
  EXPECT_FALSE(plan.confidence->limit_shares.empty());
  EXPECT_GE(plan.confidence->kept_at_least, 0.9995);
}

TEST(Confidence, DrawsHaveTheCorrelationOfTheFile) {
  Robot robot = weak_robot();
  robot.uncertainty = {{"chassis_mass_kg", 0.05}, {"resistance_ohm", 0.1}, {"model_energy", 0.0}};
  robot.uncertainty_correlations = {{"chassis_mass_kg", "resistance_ohm", -0.8}};
  const Plant plant = make_plant(robot);
  PlantDraws draws(robot, plant, 3);
  double of_mass = 0, of_ohm = 0, of_both = 0;
  for (int i = 0; i < 4000; ++i) {
    const Plant drawn = draws.next().plant;
    const double mass = drawn.robot.inertia.chassis_mass_kg / robot.inertia.chassis_mass_kg - 1;
    const double ohm = drawn.robot.motor.left.resistance_ohm / robot.motor.left.resistance_ohm - 1;
    of_mass += mass * mass, of_ohm += ohm * ohm, of_both += mass * ohm;
  }
  EXPECT_NEAR(std::sqrt(of_mass / 4000), 0.05, 0.003);
  EXPECT_NEAR(std::sqrt(of_ohm / 4000), 0.1, 0.006);
  EXPECT_NEAR(of_both / std::sqrt(of_mass * of_ohm), -0.8, 0.03);
}

/// Friction that nearly takes the whole current: the offer is of the whole limit, and works.
TEST(Confidence, AVerdictOffersAWholeLimit) {
  Robot robot = weak_robot();
  robot.uncertainty = {{"friction_torque_Nm", 0.1}, {"model_energy", 0.0}};
  const Motor& motor = robot.motor.left;
  const double friction_A = motor.friction_torque_Nm / (motor.torque_constant_Nm_A * motor.gear_ratio);
  for (const Side side : kSides) robot.motor[side].max_current_A = 1.08 * friction_A;
  const Objective least{.confidence = 0.95};
  const Plan refused = planned_for(straight(6, least), robot);
  ASSERT_EQ(refused.status, SolveStatus::infeasible) << refused.message;
  ASSERT_EQ(refused.infeasibility->reason.constraint, "motor_current") << refused.message;
  const double offered_A = refused.infeasibility->reason.relaxation.at("max_current_A");
  EXPECT_GT(offered_A, robot.motor.left.max_current_A);
  for (const Side side : kSides) robot.motor[side].max_current_A = offered_A;
  const Plan plan = planned_for(straight(6, least), robot);
  EXPECT_LE(plan.status, SolveStatus::feasible) << plan.message;
}

/// Plans with and without margins share a cache and stay what they are.
TEST(Confidence, DoesNotDependOnWhatACacheHolds) {
  AnswerCache cache;
  const auto cached = [&](Objective objective) {
    PlanOptions options{.solver = SolverChoice::fast, .nodes = 60, .baselines = false};
    options.answers.cache = &cache;
    return plan_mission(straight(6, std::move(objective)), {.robot = weak_robot()}, options);
  };
  for (int time = 0; time < 2; ++time) {
    EXPECT_EQ(cached(soonest(0.95)).duration_s,
              planned_for(straight(6, soonest(0.95)), weak_robot()).duration_s);
    EXPECT_EQ(cached({.minimize = Objective::Minimize::time}).duration_s,
              planned_for(straight(6, {.minimize = Objective::Minimize::time}), weak_robot()).duration_s);
  }
}

TEST(Confidence, MoreOfItIsNeverFaster) {
  double before_s = 0;
  for (const double confidence : {0.6, 0.9, 0.99}) {
    const Plan plan = planned_for(straight(6, soonest(confidence)), weak_robot());
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
  const Plan sure = planned_for(straight(6, objective), robot);
  objective.confidence.reset();
  const Plan plain = planned_for(straight(6, objective), robot);
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
      (void)planned_for(straight(6, soonest(0.95)), robot);
      FAIL() << "planned without " << key;
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find(key), std::string::npos) << error.what();
    }
  }
}

/// A deadline that only a plan without margins keeps: the verdict says by how much it is too early.
TEST(Confidence, AVerdictSaysWhatDeadlineIsKept) {
  const Plan fastest = planned_for(straight(6, {.minimize = Objective::Minimize::time}), weak_robot());
  const Objective tight{.deadline_s = 1.01 * fastest.duration_s, .confidence = 0.95};
  const Plan refused = planned_for(straight(6, tight), weak_robot());
  ASSERT_EQ(refused.status, SolveStatus::infeasible);
  EXPECT_NE(refused.message.find("with 95 %"), std::string::npos) << refused.message;
  ASSERT_TRUE(refused.confidence);
  EXPECT_LT(refused.confidence->kept_without, 0.95);
  Objective later = tight;
  later.deadline_s = *tight.deadline_s + refused.infeasibility->reason.amount + 1e-6;
  const Plan kept = planned_for(straight(6, later), weak_robot());
  ASSERT_LE(kept.status, SolveStatus::feasible) << kept.message;
  EXPECT_GE(kept.confidence->kept_at_least, 0.95);
  ASSERT_EQ(kept.confidence->promises.front().name, "arrival");
  EXPECT_GE(kept.confidence->promises.front().kept, kept.confidence->kept);
}

/// The energy of a charge is E (1 + sigma z) on a robot whose only error is the model's.
TEST(Confidence, GuardsTheReserveByTheModelsOwnError) {
  Robot robot = testing::nomad();
  robot.uncertainty = {{"model_energy", 0.04}};
  robot.battery.internal_resistance_ohm = 0;
  robot.power.standby_W = 1;
  const Plan free = planned_for(straight(6, {}), robot);
  const double needed_Wh = free.energy.total_J() / 3600;
  const double sigma_Wh = 0.04 * free.energy.motion_J() / 3600;
  const auto with_capacity = [&](double sigmas) {
    Robot other = robot;
    other.battery.capacity_Wh = (needed_Wh + sigmas * sigma_Wh) / (1 - robot.battery.reserve_fraction);
    return planned_for(straight(6, {.confidence = 0.95}), other);
  };
  const Plan enough = with_capacity(1.9);
  ASSERT_LE(enough.status, SolveStatus::feasible) << enough.message;
  EXPECT_NEAR(enough.confidence->kept, normal_share(1.9), 4 * share_sigma(0.95, 4000));
  const Plan too_small = with_capacity(1.4);
  ASSERT_EQ(too_small.status, SolveStatus::infeasible) << too_small.message;
  EXPECT_EQ(too_small.infeasibility->reason.constraint, "battery_reserve");
  EXPECT_NE(too_small.message.find("below its reserve and a margin of"), std::string::npos)
      << too_small.message;
  EXPECT_NEAR(too_small.confidence->kept_without, normal_share(1.4), 4 * share_sigma(0.92, 4000));
}

/// From rest at a constant current: a robot that is heavier than planned reaches the speed later, by
/// v/2 (1/a - 1/a_planned).
/// A tug whose friction and magnets are not known well, on motors of half their heat capacity.
Robot uncertain_tug(double max_winding_C) {
  Robot robot = testing::tug(max_winding_C);
  robot.uncertainty = {{"chassis_mass_kg", 0.1},
                       {"torque_constant_Nm_A", 0.05},
                       {"friction_torque_Nm", 0.1},
                       {"model_energy", 0.0}};
  return robot;
}

Robot drawn_tug(Robot robot, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  robot.inertia.chassis_mass_kg *= 1 + 0.1 * normal(random);
  const double magnets = 1 + 0.05 * normal(random);
  for (const Side side : kSides) {
    robot.motor[side].torque_constant_Nm_A *= magnets;
    robot.motor[side].voltage_constant_V_s_rad *= magnets;
    robot.motor[side].friction_torque_Nm *= 1 + 0.1 * normal(random);
  }
  return robot;
}

/// Robots drawn here, whose windings are heated along the rows of the plan by small explicit steps.
double share_cool(const Plan& plan, const Robot& robot, int draws) {
  std::mt19937_64 random(41);
  int cool = 0;
  for (int i = 0; i < draws; ++i) {
    const Sided<double> most_C = testing::highest_C(plan, drawn_tug(robot, random));
    cool += std::max(most_C.left, most_C.right) <= robot.motor.left.thermal->max_winding_C;
  }
  return static_cast<double>(cool) / draws;
}

TEST(Confidence, KeepsTheWindingsOfDrawnRobotsCool) {
  const Plan hot = tow(testing::starts(3), uncertain_tug(400));
  ASSERT_LE(hot.status, SolveStatus::feasible) << hot.message;
  const Robot robot = uncertain_tug(25 + 0.9 * (hot.winding->highest_C - 25));
  MissionRequest mission = testing::starts(3);
  const Plan plain = tow(mission, robot);
  ASSERT_LE(plain.status, SolveStatus::feasible) << plain.message;
  mission.objective.confidence = 0.9;
  const Plan sure = tow(mission, robot);
  ASSERT_LE(sure.status, SolveStatus::feasible) << sure.message;
  constexpr int kRobots = 250;
  EXPECT_LT(share_cool(plain, robot, kRobots), 0.7);
  const double cool = share_cool(sure, robot, kRobots);
  EXPECT_GT(cool, 0.9 - 3 * share_sigma(0.9, kRobots));
  EXPECT_LT(cool, 0.97);
  EXPECT_GT(sure.duration_s, plain.duration_s);
  const auto& promises = sure.confidence->promises;
  const auto heat = std::find_if(promises.begin(), promises.end(),
                                 [](const Promise& one) { return one.name == "winding_temperature"; });
  ASSERT_NE(heat, promises.end());
  EXPECT_TRUE(heat->binds);
  EXPECT_NEAR(heat->kept, cool, 4 * share_sigma(0.9, kRobots));
  EXPECT_LT(sure.winding->above_limit_K, -1) << "below the motor's own limit, not the margin's";
}

/// Numbers in a verdict's sentence.
std::vector<double> numbers_in(const Plan& refused, const std::string& sentence) {
  std::smatch found;
  std::vector<double> numbers;
  if (std::regex_search(refused.message, found, std::regex(sentence)))
    for (std::size_t k = 1; k < found.size(); ++k) numbers.push_back(std::stod(found[k]));
  return numbers;
}

/// The charge below the reserve and the margin that the sentence names is what the verdict says is missing.
TEST(Confidence, AVerdictOnTheReserveNamesTheMarginItIsMeasuredWith) {
  Robot robot = testing::nomad();
  robot.uncertainty = {{"model_energy", 0.04}, {"chassis_mass_kg", 0.1}};
  for (const double sigmas : {0.3, 1.2}) {
    for (const double confidence : {0.9, 0.99}) {
      robot.battery.capacity_Wh = 240;
      const Plan free = planned_for(straight(6, {}), robot);
      const double upper_J = free.energy.total_J() + free.battery->loss_J + sigmas * *free.energy_sigma_J;
      robot.battery.capacity_Wh = upper_J / 3600 / (1 - robot.battery.reserve_fraction);
      const Plan refused = planned_for(straight(6, {.confidence = confidence}), robot);
      if (refused.status != SolveStatus::infeasible) continue;
      const auto numbers =
          numbers_in(refused, "below its reserve and a margin of ([0-9.e-]+) % of the capacity");
      ASSERT_EQ(numbers.size(), 1u) << refused.message;
      const double missing = refused.infeasibility->reason.amount / robot.battery.capacity_Wh;
      EXPECT_NEAR(robot.battery.reserve_fraction + 0.01 * numbers[0] - least_fraction(*refused.battery),
                  missing, 2e-4)
          << sigmas << " " << confidence << refused.message;
    }
  }
}

constexpr double kHotStart_s = 13;

/// A tug whose windings heat up within seconds.
Robot hot_tug(double max_winding_C) {
  Robot robot = uncertain_tug(max_winding_C);
  for (const Side side : kSides) robot.motor[side].thermal->capacity_J_K = 2;
  return robot;
}

/// A start and a stop that the windings of a hot tug are nearly too hot for, and with margins are: there is
/// no time to drive more gently.
MissionRequest hot_start(std::optional<double> confidence, double payload_kg = 400) {
  MissionRequest mission = testing::starts(1, payload_kg);
  mission.objective.deadline_s = kHotStart_s;
  mission.objective.confidence = confidence;
  return mission;
}

Plan tow_roughly(const MissionRequest& mission, const Robot& robot) {
  return plan_mission(mission, {.robot = robot},
                      {.solver = SolverChoice::fast, .nodes = 12, .accuracy = 1e-2, .baselines = false});
}

TEST(Confidence, AVerdictOnWindingsNamesTheMarginItIsMeasuredWithAndOffersWhatIsEnough) {
  const Robot robot = hot_tug(57);
  const Plan refused = tow_roughly(hot_start(0.95), robot);
  ASSERT_EQ(refused.status, SolveStatus::infeasible) << refused.message;
  const auto numbers = numbers_in(
      refused, "reaches ([0-9.]+) C, ([0-9.]+) K above max_winding_C less a margin of ([0-9.]+) K");
  ASSERT_EQ(numbers.size(), 3u) << refused.message;
  EXPECT_NEAR(numbers[0] - numbers[1] + numbers[2], 57, 0.02) << refused.message;
  const auto& offered = refused.infeasibility->reason.relaxation;
  const auto percent = numbers_in(refused, "([0-9.]+) % less of every payload");
  ASSERT_EQ(percent.size(), offered.count("payload_kg")) << refused.message;
  for (const auto& [key, value] : offered) {
    ASSERT_EQ(key, "payload_kg") << refused.message;
    EXPECT_NEAR(400 * (1 - 0.01 * percent[0]), value, 0.05);
    const Plan kept = tow_roughly(hot_start(0.95, value), robot);
    EXPECT_LE(kept.status, SolveStatus::feasible) << refused.message << "; " << kept.message;
  }
}

/// More charge or capacity leaves the windings too hot: neither is offered.
TEST(Confidence, AVerdictOffersNoChargeThatIsInVain) {
  Robot robot = hot_tug(63);
  robot.uncertainty["model_energy"] = 0.15;
  MissionRequest mission = hot_start({});
  const Plan plain = tow_roughly(mission, robot);
  ASSERT_LE(plain.status, SolveStatus::feasible) << plain.message;
  const double used_Wh = (plain.energy.total_J() + plain.battery->loss_J) / 3600;
  robot.battery.capacity_Wh = 1.02 * used_Wh / (1 - robot.battery.reserve_fraction);
  mission.objective.confidence = 0.95;
  const Plan refused = tow_roughly(mission, robot);
  ASSERT_EQ(refused.status, SolveStatus::infeasible) << refused.message;
  EXPECT_EQ(refused.infeasibility->reason.constraint, "battery_reserve") << refused.message;
  for (const auto& [key, value] : refused.infeasibility->reason.relaxation)
    ADD_FAILURE() << key << " = " << value << " is in vain: " << refused.message;
}

/// The message of a verdict tells the offers that are left, behind other words too.
TEST(Offers, AreToldAnewWhereTheyChange) {
  Plan plan;
  plan.infeasibility.emplace();
  Infeasibility& verdict = plan.infeasibility->reason;
  verdict = {
      .constraint = "battery_power", .amount = 5, .unit = "W", .relaxation = {{"battery_fraction", 0.43}}};
  const std::string told = offers_text(verdict, {});
  verdict.message = "the battery supplies at most 90 W; " + told + "; more";
  verdict.relaxation.clear();
  tell_anew(plan, told, offers_text(verdict, {}));
  EXPECT_EQ(plan.message.find("battery_fraction"), std::string::npos) << plan.message;
  EXPECT_NE(plan.message.find("is missed by 5 W; more"), std::string::npos) << plan.message;
  EXPECT_EQ(plan.message, verdict.message);
}

TEST(Offers, AreGivenToTheMissionOrTheRobot) {
  MissionRequest mission = testing::starts(1, 400);
  Robot robot = testing::nomad();
  EXPECT_TRUE(take_offer("payload_kg", 300, mission, robot));
  EXPECT_NEAR(mission.legs[0].payload.from_kg, 300, 1e-9);
  EXPECT_TRUE(take_offer("battery_fraction", 0.5, mission, robot));
  EXPECT_EQ(mission.start.battery_fraction, 0.5);
  EXPECT_TRUE(take_offer("max_current_A", 3, mission, robot));
  EXPECT_EQ(robot.motor.right.max_current_A, 3);
  EXPECT_TRUE(take_offer("capacity_Wh", 7, mission, robot));
  EXPECT_EQ(robot.battery.capacity_Wh, 7);
  EXPECT_FALSE(take_offer("deadline_s", 7, mission, robot));
}

/// A battery with a steep curve that a mission nearly empties.
Robot sagging_tug() {
  Robot robot = uncertain_tug(400);
  robot.battery.capacity_Wh = 3;
  robot.battery.open_circuit_curve = {{0.0, 30.0}, {0.5, 44.0}, {1.0, 50.0}};
  robot.battery.internal_resistance_ohm = 0.02;
  return robot;
}

/// Charge drawn from the rows of a plan: dE = capacity (U/mean U) dz, so dz = i dt mean U/capacity.
double least_fraction_along(const Plan& plan, const Robot& robot) {
  const Trajectory rows = plan_trajectory(plan, make_plant(robot), 100);
  const double mean_V = 0.5 * (0.5 * (30.0 + 44.0) + 0.5 * (44.0 + 50.0));
  const double charge_As = robot.battery.capacity_Wh * 3600 / mean_V;
  double z = 1;
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
    const double ocv_V = z < 0.5 ? 30 + 28 * z : 38 + 12 * z;
    const double power_W = 0.5 * (rows.battery_power_W[k] + rows.battery_power_W[k + 1]);
    const double r = robot.battery.internal_resistance_ohm;
    const double current_A = (ocv_V - std::sqrt(ocv_V * ocv_V - 4 * r * power_W)) / (2 * r);
    z -= current_A * (rows.time_s[k + 1] - rows.time_s[k]) / charge_As;
  }
  return z;
}

TEST(PlanCourse, OfAnotherRobotIsTheOneOfItsOwnChargeAndHeat) {
  const Robot robot = sagging_tug();
  const Plan plan = tow(testing::starts(5), robot);
  ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
  Robot heavier = robot;
  heavier.inertia.chassis_mass_kg *= 1.15;
  for (const Side side : kSides) heavier.motor[side].friction_torque_Nm *= 1.3;
  const PlanCourses courses(plan, make_plant(robot), {.start_fraction = 1.0});
  for (const Robot& other : {robot, heavier}) {
    const PlanCourse course = courses.of(make_plant(other));
    const Sided<double> most_C = testing::highest_C(plan, other);
    EXPECT_NEAR(course.winding_use * (400 - 25), std::max(most_C.left, most_C.right) - 25, 1.0);
    const double least = least_fraction_along(plan, other);
    EXPECT_NEAR(course.least_fraction, least, 0.02 * (1 - least));
    EXPECT_NEAR(course.legs.back().least_fraction, course.least_fraction, 1e-4);
  }
  EXPECT_LT(courses.of(make_plant(heavier)).least_fraction, plan.battery->end_fraction - 0.03);
}

/// What a drawn robot uses of its battery's voltage is that of its own charge.
TEST(Confidence, ADrawnRobotHasTheVoltageOfItsOwnCharge) {
  const Robot robot = sagging_tug();
  MissionRequest mission = testing::starts(5);
  mission.objective.minimize = Objective::Minimize::time;
  const Plan plan = tow(mission, robot);
  ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
  const Plant plant = make_plant(robot);
  const PlanDemands demands(plan, robot, plant, {.start_fraction = 1.0});
  const PlanCourses courses(plan, plant, {.start_fraction = 1.0});
  PlantDraws draws(robot, plant, 5);
  const Eigen::MatrixXd errors = draws.next_errors(60);
  const std::vector<PlanDemand> found = demands.of(errors, draws);
  double moved = 0;
  for (std::size_t draw = 0; draw < found.size(); ++draw) {
    DrawnPlant drawn = demands.plant_of(draws.draw_of(errors.col(static_cast<Eigen::Index>(draw))));
    const PlanCourse estimated = std::exchange(drawn.course, courses.of(drawn.plant));
    EXPECT_NEAR(estimated.legs.back().least_fraction, drawn.course.legs.back().least_fraction, 0.03);
    const ForceUses own = ForceDemands(plan, robot, drawn, {}).nominal();
    const ForceUses of_plan = ForceDemands(plan, robot, {drawn.plant}, {}).nominal();
    for (std::size_t i = 0; i < kForceLimits; ++i) {
      if (own[i] < 0.5) continue;
      EXPECT_NEAR(found[draw].use[i], own[i], 0.004) << force_limits()[i]->name;
      moved = std::max(moved, std::abs(own[i] - of_plan[i]));
    }
  }
  EXPECT_GT(moved, 0.02) << "the voltage hardly depends on the draw: the case shows nothing";
}

TEST(Lateness, OfAHeavierRobotIsThatOfItsSlowerStart) {
  Robot robot = weak_robot();
  robot.limits->speed_m_s = 0.5;
  robot.limits->deceleration_m_s2 = 0.2;
  const Plan plan = planned_for(straight(6, {.minimize = Objective::Minimize::time}), robot);
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
