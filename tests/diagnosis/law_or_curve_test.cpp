#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "diagnosis/evidence/attribution.hpp"
#include "diagnosis/evidence/inexact_forms.hpp"
#include "diagnosis/thresholds.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "tests/support/blind_day.hpp"

namespace joulepath {
namespace {

/// A day with one strong effect, whose law the plant bends a little.
struct StrongDay {
  std::string effect{};
  double size{};  ///< of the effect's first parameter
  std::string robot_and_seed{};
};

class StrongLaw : public ::testing::TestWithParam<StrongDay> {};

/// Linearized about nothing, a curve of the yaw rate or of the speed fits better than these laws.
TEST_P(StrongLaw, IsNamedAndNoCurve) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const StrongDay& day = GetParam();
  const Diagnosis d =
      diagnose(testing::blind_day("--effect " + day.effect + " --protocol 24 " + day.robot_and_seed),
               {.bootstrap = 0});
  ASSERT_EQ(d.causes.size(), 1u) << verdict_name(d.verdict);
  EXPECT_EQ(d.causes.front().effect.name, day.effect);
  EXPECT_NEAR(d.causes.front().parameters.front().value, day.size, 0.15 * day.size);
}

INSTANTIATE_TEST_SUITE_P(Days, StrongLaw,
                         ::testing::Values(StrongDay{"turning_scrub", 1.38,
                                                     "--robot nomad --level 0 --seed 7976008345531482306"},
                                           StrongDay{"viscous_friction", 0.506,
                                                     "--robot tug --level 1 --seed 7915681761724098365"}),
                         [](const auto& day) { return day.param.effect; });

/// Coulomb friction whose strength varies with the speed is not the whole cause: Stribeck's friction is
/// there.
TEST(InexactLaw, CostsAsMuchAsAnotherCause) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Diagnosis d = diagnose(testing::blind_day("--effect coulomb_friction,stribeck_friction --robot nomad "
                                                  "--protocol 12 --level 1 --seed 3664679619050966153"),
                               {.bootstrap = 0});
  ASSERT_FALSE(d.causes.empty()) << verdict_name(d.verdict);
  EXPECT_EQ(d.causes.front().effect.name, "coulomb_friction");
  EXPECT_TRUE(d.unknowns.empty()) << d.leftover_description;
  const bool listed = std::ranges::count(d.below_materiality, "stribeck_friction", &SmallEffect::effect) > 0,
             named = d.causes.size() == 2 && d.causes[1].effect.name == "stribeck_friction";
  EXPECT_TRUE(listed || named);
}

/// One law of amplitude 1 with a form by speed, both seen independently with this variance.
struct LawWithForm {
  LinearProblem problem{};
  Equations equations{};

  LawWithForm(double form, double variance) {
    equations.candidates = {Candidate{.shape = {.name = "viscous_friction"}}};
    equations.columns = {{Column::Kind::amplitude, 0, 0, 1e3, 0.0},
                         {Column::Kind::form, 0, 0, kFormSpread, 0.0}};
    const Eigen::Vector2d truth(1, form);
    problem.gram = Eigen::Matrix2d::Identity() / variance;
    problem.right = problem.gram * truth;
    problem.residual_square = truth.dot(problem.gram * truth);
    problem.prior_sd = Eigen::Vector2d(1e3, kFormSpread);
  }
};

TEST(InexactLaw, IsOneWhoseStrengthSurelyVariesByMoreThanLawsDo) {
  const auto inexact = [](double form, double variance) {
    const LawWithForm law(form, variance);
    return inexact_forms(law.problem, law.equations, {0, 1}, 1.0);
  };
  EXPECT_EQ(inexact(0.5, 1e-6), std::vector<int>{1});
  EXPECT_EQ(inexact(-0.5, 1e-6), std::vector<int>{1});
  EXPECT_TRUE(inexact(0.1, 1e-6).empty());
  EXPECT_TRUE(inexact(0.5, 1.0).empty());  // not told by the data
}

}  // namespace
}  // namespace joulepath
