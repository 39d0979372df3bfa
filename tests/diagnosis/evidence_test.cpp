// Steps of the search for effects on small problems with known answers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/evidence/attribution.hpp"
#include "diagnosis/evidence/signatures.hpp"
#include "diagnosis/prediction/rows.hpp"
#include "diagnosis/thresholds.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

/// One column with entry 4 of the Gram matrix in each run and (nearly) no prior; the runs' scores about zero
/// are as given.
Equations runs_with_scores(const std::vector<double>& scores, Column::Kind kind = Column::Kind::amplitude) {
  Equations equations{.columns = {{kind, 0, 0, 1.0, 0.0}}, .prior_sd = Eigen::VectorXd::Constant(1, 1e6)};
  for (const double score : scores) {
    Eigen::MatrixXd gram(2, 2);
    gram << 4.0, score, score, 100.0;
    equations.runs.push_back({gram});
  }
  return equations;
}

/// Nothing fitted: (36 + 4)/(2 x 4) = 5. The fit takes the mean score of 2 away, and of each run's expected
/// square of 4 the 2 that a fit of two runs absorbs: (16 + 16)/(2 + 2) = 8.
TEST(RunDispersion, IsTheScatterOfScoresOverItsExpectation) {
  EXPECT_NEAR(run_dispersion(runs_with_scores({6, -2}), {}), 5.0, 1e-9);
  EXPECT_NEAR(run_dispersion(runs_with_scores({6, -2}), {0}), 8.0, 1e-9);
  EXPECT_NEAR(run_dispersion(runs_with_scores({10, 2}), {0}), 8.0, 1e-9);
}

TEST(RunDispersion, IsOneWhereRunsAgreeOrNothingCanTell) {
  EXPECT_EQ(run_dispersion(runs_with_scores({3, 3}), {0}), 1.0);
  EXPECT_EQ(run_dispersion(runs_with_scores({}), {0}), 1.0);
  EXPECT_EQ(run_dispersion(runs_with_scores({60, -60}, Column::Kind::dictionary), {}), 1.0);
}

/// The interval of a difference begins at zero where physics allows one sign and the effect is absent, and
/// is symmetric elsewhere; its width is the candidate's step.
TEST(AmplitudeStep, NeverTriesAnAmplitudeOfTheWrongSign) {
  const Candidate one_sign{
      .shape = {.name = "quadratic_drag"}, .amplitude = {"k"}, .step = {3.0}, .nonnegative = true};
  Candidate two_signs = one_sign;
  two_signs.nonnegative = false;
  const AmplitudeStep absent = amplitude_step({}, one_sign, 0);
  EXPECT_EQ(absent.value, std::vector<double>{0.0});
  EXPECT_EQ(absent.low, 0.0);
  EXPECT_EQ(absent.high, 1.5);
  const AmplitudeStep present = amplitude_step({.effects = {{one_sign, {2.0}}}}, one_sign, 0);
  EXPECT_EQ(present.value, std::vector<double>{2.0});
  EXPECT_EQ(present.low, -1.5);
  EXPECT_EQ(amplitude_step({.effects = {{one_sign, {1.0}}}}, one_sign, 0).low, 0.0);
  EXPECT_EQ(amplitude_step({}, two_signs, 0).low, -1.5);
}

TEST(AmplitudeStep, ChangesOneAmplitudeAndAddsWhatIsAbsent) {
  const Candidate candidate{.shape = {.name = "slope"}, .amplitude = {"x", "y"}, .step = {1.0, 1.0}};
  const ModelState changed = with_change({}, candidate, amplitude_step({}, candidate, 1), 1, 0.25);
  ASSERT_EQ(changed.effects.size(), 1u);
  EXPECT_EQ(changed.effects[0].amplitude, (std::vector<double>{0.0, 0.25}));
  const ModelState again = with_change(changed, candidate, amplitude_step(changed, candidate, 1), 1, 0.5);
  ASSERT_EQ(again.effects.size(), 1u) << "replaced, not added";
  EXPECT_EQ(again.effects[0].amplitude, (std::vector<double>{0.0, 0.75}));
}

/// With a payload of three usual ones the variable of the form is (3 - 1)/(3 + 1): a form is this part of
/// what its effect alone adds, whatever else is there.
TEST(Forms, AreTheirEffectsPartTimesTheirVariable) {
  constexpr double kViscous_Nm_s_rad = 0.01, kTorque_Nm = 0.05, kVariable = 0.5;
  constexpr int kPayload = 2;
  ASSERT_EQ(kFormVariables[kPayload], "payload");
  const Robot robot = testing::nomad();
  const Candidate viscous = bare_candidate(*find_effect("viscous_friction"), robot),
                  dry = bare_candidate(*find_effect("coulomb_friction"), robot);
  const ModelState state{.effects = {{viscous, {kViscous_Nm_s_rad}}, {dry, {kTorque_Nm}}}};
  const RunSignals run = make_run_signals(
      testing::synthetic_run(robot, "lane", 10, 3 * kUsualPayload_kg, testing::swinging(0.5, 0.2, 1.1)), 0,
      robot);
  const std::vector<Column> columns = list_columns({}, state, {viscous, dry}, 0, Forms::active);
  const std::vector<Eigen::MatrixXd> rows =
      signatures(run, robot, {}, state, {viscous, dry}, columns, predict(run, model_point(robot, {}, state)));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].kind != Column::Kind::form || columns[k].part != kPayload) continue;
    for (Eigen::Index j = 0; j < run.size(); ++j) {
      const double torque_Nm =
          columns[k].owner == 0 ? kViscous_Nm_s_rad * run.wheel_speed_rad_s.left[j] : kTorque_Nm;
      EXPECT_NEAR(rows[k](j, kCurrentLeft), kVariable * torque_Nm / robot.motor.left.torque_per_ampere_Nm_A(),
                  1e-9);
    }
  }
  EXPECT_EQ(std::ranges::count(columns, Column::Kind::form, &Column::kind), 2 * std::ssize(kFormVariables));
}

/// What the nuisance of a key adds to the rows of a run, in its 1-sigma.
Eigen::MatrixXd rows_of_nuisance(const RunSignals& run, const Robot& robot, const std::string& key) {
  const std::vector<Nuisance> nuisances{{key, std::nullopt, 1.0}};
  const ModelState state{.nuisance_fraction = {0.0}};
  return signatures(run, robot, nuisances, state, {}, list_columns(nuisances, state, {}, 0, Forms::none),
                    predict(run, model_point(robot, nuisances, state)))
      .front();
}

/// A pose that every row reads and that is two rows late, on a run that ends elsewhere: the column is what
/// its lateness adds to the rows, whose mean is free.
TEST(LatePose, IsItsColumn) {
  const Robot robot = testing::nomad();
  const testing::MotionLaw law = [](double t) {
    return BodyMotion<double>{.speed_m_s = 0.4 * (1 - std::exp(-t)),
                              .acceleration_m_s2 = 0.4 * std::exp(-t),
                              .yaw_rate_rad_s = 0.5 * std::sin(0.8 * t),
                              .yaw_acceleration_rad_s2 = 0.4 * std::cos(0.8 * t)};
  };
  joulepath::Run sharp = testing::synthetic_run(robot, "one way", 10, 2.0, law);
  double x_m = 0, y_m = 0;
  for (const double t : sharp.log.time_s) {
    const double heading_rad = 0.5 / 0.8 * (1 - std::cos(0.8 * t));
    sharp.log.heading_rad.push_back(heading_rad);
    sharp.log.position_x_m.push_back(x_m += 0.02 * law(t).speed_m_s * std::cos(heading_rad));
    sharp.log.position_y_m.push_back(y_m += 0.02 * law(t).speed_m_s * std::sin(heading_rad));
  }
  joulepath::Run late = sharp;
  const double late_s = 2 * (sharp.log.time_s[1] - sharp.log.time_s[0]);
  for (auto* channel : {&late.log.position_x_m, &late.log.position_y_m, &late.log.heading_rad})
    std::shift_right(channel->begin(), channel->end(), 2);
  const auto rows_of = [&](const RunSignals& signals) {
    return residual_rows(signals, {.robot = robot}, predict(signals, {.robot = robot})).value;
  };
  const RunSignals signals = make_run_signals(late, 0, robot);
  const Eigen::MatrixXd change = rows_of(signals) - rows_of(make_run_signals(sharp, 0, robot)),
                        column = late_s / (kReadingDelay * signals.reading_period_s.pose_s) *
                                 rows_of_nuisance(signals, robot, kPoseStampNuisance);
  for (const Channel pose : {kHeading, kPositionX, kPositionY}) {
    ASSERT_GT(change.col(pose).cwiseAbs().maxCoeff(), 0.002) << pose;
    EXPECT_LT((change - column).col(pose).cwiseAbs().maxCoeff(), 0.1 * change.col(pose).cwiseAbs().maxCoeff())
        << pose;
  }
}

TEST(UnstatedPayloadWidth, IsTheLimitOrAShareOfTheRobot) {
  Robot robot = testing::nomad();
  EXPECT_EQ(payload_prior_sd_kg(robot), 12.0);
  robot.limits->max_payload_kg = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(payload_prior_sd_kg(robot), kUnstatedPayloadShare * (21.2 + 2 * 1.39), 1e-12);
}

}  // namespace
}  // namespace joulepath
