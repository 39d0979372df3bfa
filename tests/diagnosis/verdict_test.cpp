// What follows from the outcome of the race, and calibration constants outside of their uncertainty, on
// problems with one or two columns whose answers are known in closed form.
#include "diagnosis/verdict/verdict.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/evidence/boxed_fit.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

constexpr double kNoiseSquare = 50.0;  ///< r'r of the readings' noise

/// Equations of one run. The columns are orthogonal or given by `gram`; the runs place parameter k at
/// `place[k]` prior standard deviations.
Equations equations_at(const std::vector<Column>& columns, const Eigen::MatrixXd& gram,
                       const Eigen::VectorXd& place) {
  const Eigen::Index n = gram.rows();
  Eigen::MatrixXd whole(n + 1, n + 1);
  whole << gram, gram * place, (gram * place).transpose(), place.dot(gram * place) + kNoiseSquare;
  return {.columns = columns, .runs = {{whole}}, .prior_sd = Eigen::VectorXd::Ones(n)};
}

/// The friction of the left wheel at this many standard deviations from the robot file's; beside it a law
/// whose signature has this cosine with that of the constant.
Identification constant_at(double sigmas, double cosine_of_law = 0.0) {
  Identification id;
  id.nuisances = {{.key = "friction_torque", .side = Side::left, .sigma = 0.03}};
  Eigen::MatrixXd gram(2, 2);
  gram << 100, 100 * cosine_of_law, 100 * cosine_of_law, 100;
  id.equations =
      equations_at({{Column::Kind::nuisance, 0, 0, 1.0, 0.0}, {Column::Kind::amplitude, 0, 0, 1.0, 0.0}},
                   gram, Eigen::Vector2d(sigmas, 0));
  id.equations.candidates = {Candidate{.shape = {.name = "coulomb_friction"}}};
  id.problem = without_calibration(id.equations, {0});
  id.explanations = {{}};
  return id;
}

Judgment judged(const Identification& id, const Names& names = {}, bool few = false) {
  const Dataset dataset;
  const RunsByUse runs{.few = few};
  return judge({.dataset = dataset, .runs = runs, .id = id}, names);
}

Names named_with(double probability, std::vector<UnknownCause> unknowns = {}) {
  const Candidate drag{.shape = {.name = "quadratic_drag"}};
  return {.named = {{drag, {1.0}}},
          .unknowns = std::move(unknowns),
          .probabilities = {{drag.label(), probability}}};
}

TEST(Judgment, FollowsFromWhatWonTheRace) {
  const Identification id = constant_at(0.5);
  EXPECT_EQ(judged(id).verdict, Verdict::no_gap);
  EXPECT_EQ(judged(id, named_with(0.9)).verdict, Verdict::explained);
  EXPECT_EQ(judged(id, named_with(0.5)).verdict, Verdict::ambiguous);
  const std::vector<UnknownCause> unknowns{{.depends_on = "wheel speed (current)"},
                                           {.depends_on = "payload (current)"}};
  const Judgment part = judged(id, named_with(0.9, {unknowns[0]})), none = judged(id, {.unknowns = unknowns});
  EXPECT_EQ(part.verdict, Verdict::partly_explained);
  EXPECT_EQ(part.named.size(), 1u);
  EXPECT_EQ(none.verdict, Verdict::unexplained);
  EXPECT_EQ(none.depends_on, "depends on wheel speed (current), then payload (current)");
}

TEST(Judgment, OfTooFewRunsClaimsNothing) {
  const Judgment few = judged(constant_at(10), named_with(0.95), true);
  EXPECT_EQ(few.verdict, Verdict::too_little_data);
  EXPECT_TRUE(few.named.empty() && few.unknowns.empty());
  EXPECT_EQ(few.notes.size(), 1u);
}

/// At 3.5 standard deviations a constant held at 3 leaves 100 x 0.5^2 + 50 = 75 of 1275, free 62: too little
/// to call it wrong. At 10 it leaves 4950 of 10050, free 149.
TEST(Judgment, NamesAConstantFarOutsideItsUncertaintyOnly) {
  for (const double sigmas : {-3.5, 2.9, 3.5})
    EXPECT_EQ(judged(constant_at(sigmas)).verdict, Verdict::no_gap) << sigmas;
  for (const double sigmas : {-10.0, 10.0}) {
    const Judgment far = judged(constant_at(sigmas));
    EXPECT_EQ(far.verdict, Verdict::unexplained) << sigmas;
    EXPECT_NE(far.depends_on.find("friction"), std::string::npos) << far.depends_on;
    for (const auto& [probability, verdict] :
         {std::pair{0.2, Verdict::ambiguous}, std::pair{0.8, Verdict::explained}}) {
      const Judgment law =
          judged(constant_at(sigmas, 0.995), {.probabilities = {{"coulomb_friction", probability}}});
      EXPECT_EQ(law.verdict, verdict) << "the law that changes the same number";
      ASSERT_EQ(law.named.size(), 1u);
      EXPECT_EQ(law.named[0].candidate.label(), "coulomb_friction");
    }
    for (const double probability : {0.0, 0.01}) {
      const Judgment unlikely =
          judged(constant_at(sigmas, 0.995), {.probabilities = {{"coulomb_friction", probability}}});
      EXPECT_EQ(unlikely.verdict, Verdict::unexplained) << "a law that the race gives hardly any probability";
      EXPECT_TRUE(unlikely.named.empty());
    }
  }
}

/// A constant at 10 standard deviations scores about 100/2 less the cost of a free one.
TEST(Judgment, AConstantDisplacesAnExplanationThatIsWorse) {
  Identification id = constant_at(10);
  const double score = score_of_constant(id, 0);
  EXPECT_GT(score, 30);
  EXPECT_LT(score, 50);
  id.explanations[0].score = score - 1;
  EXPECT_EQ(judged(id, named_with(0.9)).verdict, Verdict::unexplained);
  id.explanations[0].score = score + 1;
  EXPECT_EQ(judged(id, named_with(0.9)).verdict, Verdict::explained);
  Identification stood_for = constant_at(10, 0.995);
  stood_for.explanations[0].score = score - 1;
  EXPECT_EQ(judged(stood_for, named_with(0.9)).named.at(0).candidate.label(), "quadratic_drag");
}

/// Outcome of a race of one law and one form of it, each with this gram, at these places.
Names names_of_form(double gram, double strength, double variation) {
  Identification id;
  id.equations =
      equations_at({{Column::Kind::amplitude, 0, 0, 1.0, 0.0}, {Column::Kind::form, 0, 0, kFormSpread, 0.0}},
                   gram * Eigen::Matrix2d::Identity(), Eigen::Vector2d(strength, variation));
  id.equations.prior_sd[1] = kFormSpread;
  const Candidate friction{.shape = {.name = "coulomb_friction"}, .amplitude = {"torque_Nm"}, .step = {0.01}};
  id.equations.candidates = {friction};
  id.problem = without_calibration(id.equations, {0});
  id.explanations = search_explanations(id.problem, id.equations, {});
  id.state.effects = {{friction, {strength}}};
  id.signals = {RunSignals{.motor_power_W = {Eigen::VectorXd::Ones(1), Eigen::VectorXd::Ones(1)}}};
  id.signals[0].time_s = Eigen::VectorXd::Zero(1);
  const Dataset dataset{.robot = testing::nomad()};
  const RunsByUse runs;
  return choose_names({.dataset = dataset, .runs = runs, .id = id});
}

/// A named law whose strength varies by half with the speed: of what law and form explain, the form's part
/// is unknown.
TEST(InexactForm, HasItsShareOfWhatIsExplained) {
  constexpr double kGram = 1e4, kStrength = 1.0, kVariation = 0.5;
  const Names names = names_of_form(kGram, kStrength, kVariation);
  ASSERT_EQ(names.unknowns.size(), 1u);
  const auto explained = [](double place, double prior_sd) {
    return std::pow(kGram * place, 2) / (kGram + 1 / (prior_sd * prior_sd));
  };
  const double form = explained(kVariation, kFormSpread), law = explained(kStrength, 1.0);
  EXPECT_NEAR(names.unknowns[0].share, form / (form + law), 1e-9);
}

/// Gram 1e4: the form is known to 0.01. Gram 100: to 0.077, and the prior draws it to 0.59 of its place.
TEST(InexactForm, IsToldFromAFifthOnWhereTheRunsAreSure) {
  for (const double sign : {1.0, -1.0}) {
    EXPECT_EQ(names_of_form(1e4, 1.0, sign * 0.25).unknowns.size(), 1u);
    EXPECT_TRUE(names_of_form(1e4, 1.0, sign * 0.21).unknowns.empty()) << "0.209, less 0.02";
    EXPECT_TRUE(names_of_form(1e4, 1.0, sign * 0.12).unknowns.empty());
    EXPECT_TRUE(names_of_form(100, 2.0, sign * 0.4).unknowns.empty()) << "0.236, less 0.15";
  }
}

/// Held at 3 of 5 and of -10 standard deviations, the furthest first; the third one is fitted.
TEST(BoxedFit, HoldsConstantsAtTheBorderOfTheirUncertainty) {
  for (const double sd : {1.0, 0.03}) {
    Identification id;
    const Column constant{Column::Kind::nuisance, 0, 0, sd, 0.0};
    id.equations = equations_at({constant, constant, constant}, 100 / (sd * sd) * Eigen::Matrix3d::Identity(),
                                sd * Eigen::Vector3d(5, 2, -10));
    id.equations.prior_sd.setConstant(sd);
    const BoxedFit fit = fit_within_calibration(id);
    EXPECT_EQ(fit.held, (std::vector<int>{2, 0}));
    const double fitted = 100 * 2 * 2 - 200.0 * 200.0 / 101;
    EXPECT_NEAR(fit.loss, 100 * 7 * 7 + 100 * 2 * 2 + fitted + kNoiseSquare, 1e-6) << sd;
  }
}

TEST(EffectOfAConstant, HasTheSameSignatureUpToSign) {
  EXPECT_EQ(effect_of_constant(constant_at(0, 0.98), 0), -1);
  EXPECT_EQ(effect_of_constant(constant_at(0, 0.995), 0), 0);
  EXPECT_EQ(effect_of_constant(constant_at(0, -0.995), 0), 0);
}

}  // namespace
}  // namespace joulepath
