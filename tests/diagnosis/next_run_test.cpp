// The proposed run: what it separates, and the robot's limits.
#include "diagnosis/next_run/next_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "diagnosis/next_run/rivals.hpp"
#include "model/kinematics.hpp"
#include "model/limit_table.hpp"
#include "model/motions.hpp"
#include "model/operating_point.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

constexpr testing::LogNoise kNoise{.speed_rad_s = 0.01, .current_A = 0.01, .voltage_V = 0.02};

/// Present runs: forward on a lane at one speed, with one payload. Nothing in them tells a resistance that
/// depends on speed, load or direction from a constant one.
std::vector<RunSignals> plain_lanes(const Robot& robot, bool voltages) {
  std::vector<RunSignals> runs;
  for (unsigned k = 0; k < 4; ++k) {
    Run run = testing::synthetic_run(robot, "lane", 12, 6, testing::constant_speed(0.3), kNoise, k + 1);
    if (!voltages) run.log.motor_voltage_V = {};
    runs.push_back(make_run_signals(run, k, robot));
  }
  return runs;
}

/// A robot with twice the typical size of the one of the effects that changes its constants.
Robot robot_with_one_of(const std::vector<std::string>& effects, const Robot& robot) {
  for (const std::string& effect : effects) {
    const EffectDescription* described = find_effect(effect);
    if (!described || described->info.stage != Stage::parameters) continue;
    const Candidate candidate = bare_candidate(*described, robot);
    return make_plant(robot, {setting_of(candidate, {2 * candidate.step[0]}, robot)}).robot;
  }
  ADD_FAILURE() << "no effect changes a constant";
  return robot;
}

/// The present runs of that robot, and each effect as an explanation.
Identification rivals(const Robot& robot, const std::vector<std::string>& effects, bool voltages = true) {
  Identification id;
  id.nuisances = calibration_nuisances(robot);
  id.state.nuisance_fraction.assign(id.nuisances.size(), 0.0);
  id.signals = plain_lanes(robot_with_one_of(effects, robot), voltages);
  id.equations = build_equations(id.signals, robot, id.nuisances, id.state, {}, {});
  for (const std::string& effect : effects)
    for (std::size_t c = 0; c < id.equations.candidates.size(); ++c)
      if (id.equations.candidates[c].label() == effect) {
        const int candidate = static_cast<int>(c);
        id.explanations.push_back(
            {.candidates = {candidate}, .columns = id.equations.columns_of_candidate(candidate, true)});
        break;
      }
  return id;
}

NextExperiment proposal(const Robot& robot, const std::string& effect, const std::string& rival,
                        bool voltages = true) {
  const Cause cause{.effect = {.name = effect}, .indistinguishable_from = {rival}};
  return propose_run(rivals(robot, {effect, rival}, voltages), robot, {cause}, {}, Verdict::explained);
}

/// A robot whose limits are below the usual pace of the manoeuvres, with load more so.
Robot slow_robot() {
  Robot robot = testing::nomad();
  robot.limits->speed_m_s = 2.0;  // arcs and spins need their own bounds
  robot.limits->acceleration_m_s2 = 0.2;
  robot.limits->lateral_acceleration_m_s2 = 0.1;
  robot.limits->yaw_rate_rad_s = 0.3;
  robot.limits->yaw_acceleration_rad_s2 = 0.15;
  robot.limits_by_payload = {{.payload_kg = 0, .limit_by_key = {{"deceleration_m_s2", 0.18}}},
                             {.payload_kg = 12, .limit_by_key = {{"deceleration_m_s2", 0.1}}}};
  return robot;
}

/// A robot whose motors cannot drive every manoeuvre.
constexpr double kWeakest_A = 0.36;
Robot weak_robot() {
  Robot robot = testing::nomad();
  for (const Side side : kSides) robot.motor[side].max_current_A = kWeakest_A;
  return robot;
}

struct Pair {
  const char* effect;
  const char* rival;
  const char* word;  ///< of the reason for the run
};

class ProposedRun : public ::testing::TestWithParam<Pair> {};

TEST_P(ProposedRun, SeparatesTheRivalsByTheirDifference) {
  const NextExperiment next = proposal(testing::nomad(), GetParam().effect, GetParam().rival);
  EXPECT_EQ(next.separates, (std::vector<std::string>{GetParam().effect, GetParam().rival}));
  EXPECT_GT(next.expected_evidence, 0.0);
  EXPECT_NE(next.why.find(GetParam().word), std::string::npos) << next.why;
}

/// Limits of the motion at each instant, with the payload that is proposed.
TEST_P(ProposedRun, KeepsTheRobotsLimitsWithItsPayload) {
  for (const Robot& robot : {testing::nomad(), slow_robot()}) {
    const NextExperiment next = proposal(robot, GetParam().effect, GetParam().rival);
    ASSERT_FALSE(next.motions.empty());
    EXPECT_LE(std::ranges::max(next.payload_kg), payload_limit_kg(robot));
    const Trajectory drive =
        timed_motion(robot, next.motions, {.payload_of_motion_kg = next.payload_kg}).trajectory;
    for (std::size_t k = 0; k + 1 < drive.size(); ++k) {
      const Limits limits = limits_for_payload(robot, drive.payload_kg[k + 1]);
      const double step_s = drive.time_s[k + 1] - drive.time_s[k];
      const double v = drive.linear_speed_m_s[k], omega = drive.angular_speed_rad_s[k];
      constexpr double kOne = 1 + 1e-6;
      EXPECT_LE(std::abs(v), limits.speed_m_s * kOne);
      EXPECT_LE(std::abs(omega), limits.yaw_rate_rad_s * kOne);
      EXPECT_LE(std::abs(v * omega), limits.lateral_acceleration_m_s2 * kOne);
      if (step_s < 1e-6) continue;
      const double gain = (std::abs(drive.linear_speed_m_s[k + 1]) - std::abs(v)) / step_s;
      EXPECT_LE(gain, limits.acceleration_m_s2 * kOne);
      EXPECT_GE(gain, -limits.deceleration_m_s2 * kOne);
      EXPECT_LE(std::abs(drive.angular_speed_rad_s[k + 1] - omega) / step_s,
                limits.yaw_acceleration_rad_s2 * kOne);
    }
  }
}

TEST_P(ProposedRun, KeepsTheMotorsLimits) {
  const Robot robot = weak_robot();
  const Plant plant = make_plant(robot);
  const NextExperiment next = proposal(robot, GetParam().effect, GetParam().rival);
  ASSERT_FALSE(next.motions.empty());
  const Trajectory drive =
      timed_motion(robot, next.motions, {.payload_of_motion_kg = next.payload_kg}).trajectory;
  for (std::size_t k = 0; k + 1 < drive.size(); ++k) {
    const double step_s = drive.time_s[k + 1] - drive.time_s[k];
    if (step_s < 1e-6) continue;
    const BodyMotion<double> body{0.5 * (drive.linear_speed_m_s[k] + drive.linear_speed_m_s[k + 1]),
                                  (drive.linear_speed_m_s[k + 1] - drive.linear_speed_m_s[k]) / step_s,
                                  0.5 * (drive.angular_speed_rad_s[k] + drive.angular_speed_rad_s[k + 1]),
                                  (drive.angular_speed_rad_s[k + 1] - drive.angular_speed_rad_s[k]) / step_s};
    const Site site =
        site_of(robot.geometry, {}, drive.payload_kg[k + 1], body.speed_m_s, body.yaw_rate_rad_s);
    for (const Side side : kSides)
      ASSERT_LE(std::abs(operating_point(plant, body, site)[side].current_A), kWeakest_A * (1 + 1e-6)) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Effects, ProposedRun,
                         ::testing::Values(Pair{"direction_dependent_friction", "coulomb_friction",
                                                "both directions"},
                                           Pair{"rolling_resistance", "coulomb_friction", "payload"},
                                           Pair{"viscous_friction", "coulomb_friction", "arcs"}),
                         [](const auto& pair) { return std::string(pair.param.effect); });

/// One more run of the same kind changes nothing: either rival fits it as well. With another load one fits.
TEST(ProposedRun, IsWeighedWithAmplitudesAndCalibrationFittedAnew) {
  const Robot robot = testing::nomad();
  const Identification id = rivals(robot, {"rolling_resistance", "coulomb_friction"});
  const std::vector<Rival> both = fitted_rivals(id, robot, {"rolling_resistance", "coulomb_friction"});
  ASSERT_EQ(both.size(), 2U);
  const auto ratio_of = [&](double payload_kg) {
    const RunSignals motion = make_run_signals(
        testing::synthetic_run(robot, "further", 12, payload_kg, testing::constant_speed(0.3)), 0, robot);
    return expected_ratio(id, robot, expected_signals(id, robot, motion, both[0]), both[1]);
  };
  EXPECT_LT(ratio_of(6), 0.5);
  EXPECT_GT(ratio_of(12), 20 * ratio_of(6));
}

/// Where the currents alone are logged, no motion tells a weak magnet from a sensor that reads too much.
TEST(ProposedRun, SaysWhereNoRunIsLikelyToSettleTheQuestion) {
  const Robot robot = testing::nomad();
  const NextExperiment blind = proposal(robot, "torque_constant_error", "current_sensor_gain", false),
                       sighted = proposal(robot, "rolling_resistance", "coulomb_friction");
  EXPECT_LT(blind.probability_settled, 0.5);
  EXPECT_GT(sighted.probability_settled, 0.9);
  EXPECT_LE(sighted.probability_settled, 1.0);
}

/// Voltages are evidence, too: a driver's drop shows in nothing else.
TEST(ProposedRun, UsesTheVoltagesThatTheRunWillMeasure) {
  const NextExperiment next = proposal(testing::nomad(), "driver_voltage_drop", "winding_resistance_error");
  EXPECT_GT(next.expected_evidence, 1.0);
}

TEST(ProposedRun, OfASidedEffectKeepsItsSide) {
  const Robot robot = testing::nomad();
  const Cause cause{.effect = {.name = "dragging_wheel", .side = Side::left},
                    .indistinguishable_from = {"coulomb_friction"}};
  const NextExperiment next = propose_run(rivals(robot, {"coulomb_friction", "dragging_wheel (left)"}), robot,
                                          {cause}, {}, Verdict::explained);
  EXPECT_EQ(next.separates, (std::vector<std::string>{"dragging_wheel (left)", "coulomb_friction"}));
}

TEST(ProposedRun, IsNoneWhereNothingIsLeftToSeparate) {
  const Robot robot = testing::nomad();
  const Cause clear{.effect = {.name = "coulomb_friction"}};
  EXPECT_TRUE(propose_run(rivals(robot, {"coulomb_friction"}), robot, {clear}, {}, Verdict::explained)
                  .motions.empty());
  const Cause alone{.effect = {.name = "coulomb_friction"}, .indistinguishable_from = {"of no candidate"}};
  EXPECT_TRUE(propose_run(rivals(robot, {"coulomb_friction"}), robot, {alone}, {}, Verdict::explained)
                  .motions.empty());
}

TEST(ProposedRun, WithAnOpenVerdictSeparatesTheFirstOfTheRanking) {
  const Robot robot = testing::nomad();
  const Identification id =
      rivals(robot, {"coulomb_friction", "viscous_friction", "rolling_resistance", "quadratic_drag"});
  const std::vector<RankedEffect> ranking{{"coulomb_friction", 0.4},
                                          {"viscous_friction", 0.3},
                                          {"rolling_resistance", 0.2},
                                          {"quadratic_drag", 0.1}};
  const NextExperiment next = propose_run(id, robot, {}, ranking, Verdict::ambiguous);
  EXPECT_EQ(next.separates,
            (std::vector<std::string>{"coulomb_friction", "viscous_friction", "rolling_resistance"}));
  EXPECT_TRUE(propose_run(id, robot, {}, ranking, Verdict::no_gap).motions.empty());
}

}  // namespace
}  // namespace joulepath
