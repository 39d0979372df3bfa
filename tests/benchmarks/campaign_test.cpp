// A short version of the campaigns in benchmarks/bounds: problems of four robots, with every goal of time.
#include "benchmarks/problems/campaign.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "benchmarks/support/robots.hpp"
#include "planner/motion/replay.hpp"
#include "planner/profile/profile_solver.hpp"
#include "tests/support/locations.hpp"

namespace joulepath::problems {
namespace {

TEST(Campaign, FastSolverHandsNothingOverAndBoundsAreBelowThePlans) {
  const std::vector<Robot> robots = four_robots(JOULEPATH_SOURCE_DIR "/scenarios/robots/");
  for (unsigned index = 0; index < 48; ++index) {
    const std::optional<CampaignProblem> one = campaign_problem(robots, 7, index);
    if (!one) continue;
    const ProfileRequest& request = one->problem.request;
    const ProfileResult result = solve_profile(request);
    ASSERT_TRUE(result.profile) << index << " " << result.summary.message;
    EXPECT_EQ(result.summary.handed_over, "") << index;
    const ReplayResult again = replay(request, *result.profile);
    EXPECT_TRUE(again.valid()) << index << " " << again.limit << " " << again.worst_violation;
    if (request.time.mode == TimeMode::minimum_time) {
      EXPECT_LE(result.summary.lower_bound_s, again.duration_s * (1 + 1e-9)) << index;
    } else {
      EXPECT_LE(result.summary.lower_bound_J, again.energy_J * (1 + 1e-9)) << index;
    }
  }
}

/// Optima at which the rounding of the gradient is above the solver's tolerance: tight corners, a straight
/// line and a bend of heavy robots, found by the campaign. The fast solver must solve them.
TEST(Campaign, RoundingOfTheGradientIsNoReasonToHandOver) {
  const std::vector<Robot> robots = four_robots(JOULEPATH_SOURCE_DIR "/scenarios/robots/");
  for (unsigned index : {43U, 830U, 3817U, 3864U}) {
    const std::optional<CampaignProblem> one = campaign_problem(robots, 20261123, index);
    ASSERT_TRUE(one);
    const ProfileResult result = solve_profile(one->problem.request);
    EXPECT_TRUE(result.profile) << result.summary.message;
    EXPECT_EQ(result.summary.handed_over, "") << index;
  }
}

/// Optima at which a load stays at the kink of gear loss or driver drop: the exact kink made Newton's steps
/// swing, here and in Ipopt.
TEST(Campaign, LoadsThatStayAtAKinkAreSolved) {
  const std::vector<Robot> robots = four_robots(JOULEPATH_SOURCE_DIR "/scenarios/robots/");
  for (unsigned index : {319U, 395U, 431U, 552U, 574U, 616U, 970U}) {
    const std::optional<CampaignProblem> one = campaign_problem(robots, 20261123, index);
    ASSERT_TRUE(one);
    const ProfileResult result = solve_profile(one->problem.request);
    ASSERT_TRUE(result.profile) << index << " " << result.summary.message;
    EXPECT_EQ(result.summary.handed_over, "") << index;
    EXPECT_TRUE(replay(one->problem.request, *result.profile).valid()) << index;
  }
}

TEST(Campaign, AProblemIsAFunctionOfItsIndex) {
  const std::vector<Robot> robots = four_robots(JOULEPATH_SOURCE_DIR "/scenarios/robots/");
  for (unsigned index : {3U, 8U}) {
    const auto one = campaign_problem(robots, 7, index), again = campaign_problem(robots, 7, index);
    ASSERT_TRUE(one && again);
    EXPECT_EQ(problem_json(one->problem).dump(), problem_json(again->problem).dump());
    const auto other = campaign_problem(robots, 7, index + 16);
    ASSERT_TRUE(other);
    EXPECT_NE(problem_json(one->problem)["path"].dump(), problem_json(other->problem)["path"].dump());
  }
}

}  // namespace
}  // namespace joulepath::problems
