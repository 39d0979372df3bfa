#include <gtest/gtest.h>

#include <string>

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

}  // namespace
}  // namespace joulepath
