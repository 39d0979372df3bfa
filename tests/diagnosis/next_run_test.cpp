// The proposed run: what it separates, and the robot's limits.
#include "diagnosis/next_run/next_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "model/limit_table.hpp"
#include "model/motions.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// Effects of their typical sizes, or of these, each of which explains the same data as well as the
/// others.
Identification rivals(const Robot& robot, const std::vector<std::string>& effects,
                      const std::vector<double>& sizes = {}) {
  constexpr double kInformation = 1e9;
  Identification id;
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(std::ssize(effects) + 1, std::ssize(effects) + 1);
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const int column = static_cast<int>(k);
    const EffectDescription* effect = find_effect(effects[k]);
    EXPECT_NE(effect, nullptr) << effects[k];
    id.equations.candidates.push_back(bare_candidate(*effect, robot));
    const double size = sizes.empty() ? id.equations.candidates.back().step[0] : sizes[k];
    id.equations.columns.push_back({Column::Kind::amplitude, column, 0, 100 * size, 0.0});
    gram(column, column) = kInformation / (size * size);
    gram(column, std::ssize(effects)) = gram(std::ssize(effects), column) = kInformation / size;
    id.explanations.push_back({.candidates = {column}, .columns = {column}});
  }
  id.equations.prior_sd = Eigen::VectorXd::Constant(std::ssize(effects), 1e3);
  id.equations.runs = {{gram}};
  id.equations.noise = white_noise({});
  return id;
}

NextExperiment proposal(const Robot& robot, const std::string& effect, const std::string& rival,
                        const std::vector<double>& sizes = {}) {
  const Cause cause{.effect = {.name = effect}, .indistinguishable_from = {rival}};
  return propose_run(rivals(robot, {effect, rival}, sizes), robot, {cause}, {}, Verdict::explained);
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
    EXPECT_LE(next.payload_kg, payload_limit_kg(robot));
    const Limits limits = limits_for_payload(robot, next.payload_kg);
    const Trajectory drive = timed_motion(robot, next.motions, {.payload_kg = next.payload_kg}).trajectory;
    for (std::size_t k = 0; k + 1 < drive.size(); ++k) {
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

INSTANTIATE_TEST_SUITE_P(Effects, ProposedRun,
                         ::testing::Values(Pair{"direction_dependent_friction", "coulomb_friction", "crawl"},
                                           Pair{"rolling_resistance", "coulomb_friction", "payload"},
                                           Pair{"turning_scrub", "coulomb_friction", "arcs"},
                                           Pair{"viscous_friction", "quadratic_drag", "fast run"},
                                           Pair{"yaw_inertia_error", "coulomb_friction", "spins"}),
                         [](const auto& pair) { return std::string(pair.param.effect); });

/// Half of the Nomad's limit of acceleration: only hard starts are meant to be hard. Friction in reverse
/// needs the lane in both directions where the robot is slow, friction that grows with load the lane with
/// load.
TEST(ProposedRun, OnALaneIsGentle) {
  Robot slow = testing::nomad();
  slow.limits->speed_m_s = 0.2;
  const NextExperiment both =
      proposal(slow, "direction_dependent_friction", "coulomb_friction", {0.05, 1e-4});
  const NextExperiment loaded = proposal(slow, "rolling_resistance", "coulomb_friction");
  EXPECT_NE(both.why.find("lane in both directions"), std::string::npos) << both.why;
  EXPECT_NE(loaded.why.find("lane with the greatest payload"), std::string::npos) << loaded.why;
  for (const NextExperiment& next : {both, loaded})
    for (const PrescribedMotion& motion : next.motions)
      EXPECT_LE(motion.acceleration_m_s2.value_or(0.0), 0.5 * testing::nomad().limits->acceleration_m_s2);
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
