// The specification of each mode of time, the price of a second, speeds at the ends, and the requested
// accuracy.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "planner/motion/path_motion.hpp"
#include "planner/motion/replay.hpp"
#include "planner/nlp/transcription/problem.hpp"
#include "planner/profile/dense_check.hpp"
#include "planner/profile/profile_solver.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

PathPiece curve() { return Curve({BezierSegment({{{0, 0}, {1.5, 0}, {2.7, 1.2}, {2.7, 2.7}}})}); }

ProfileRequest request_for(TimeGoal time, SolverChoice solver = SolverChoice::fast) {
  Robot robot = testing::nomad();
  robot.power.standby_W = 1;  // so that a longer time saves energy
  return {.piece = curve(),
          .plant = make_plant(robot),
          .limits = *robot.limits,
          .time = time,
          .nodes = 100,
          .solver = solver};
}

struct Driven {
  double duration_s{};
  double energy_J{};  ///< standby included
  double price_W{};
};

Driven drive(const ProfileRequest& request) {
  const ProfileResult result = solve_profile(request);
  EXPECT_TRUE(result.profile) << result.summary.message;
  if (!result.profile) return {};
  const ReplayResult again = replay(request, *result.profile);
  EXPECT_TRUE(again.valid()) << again.limit << " " << again.worst_violation << " at " << again.s;
  return {again.duration_s, again.energy_J, result.summary.price_of_time_W};
}

class EverySolver : public ::testing::TestWithParam<SolverChoice> {
 protected:
  Driven in(TimeGoal time) const { return drive(request_for(time, GetParam())); }
};

TEST_P(EverySolver, EveryModeOfTimeKeepsItsPromise) {
  const Driven least = in({.mode = TimeMode::minimum_time}), free = in({.mode = TimeMode::free_time});
  ASSERT_GT(free.duration_s, 1.02 * least.duration_s);
  for (double share : {0.3, 1.0, 1.4}) {
    const double T = least.duration_s + share * (free.duration_s - least.duration_s);
    const Driven fixed = in({.mode = TimeMode::fixed_time, .duration_s = T});
    EXPECT_NEAR(fixed.duration_s, T, 1e-7 * T);
    EXPECT_GE(fixed.energy_J, free.energy_J * (1 - 1e-6));
    const Driven budget = in({.mode = TimeMode::time_budget, .duration_s = T});
    EXPECT_LE(budget.duration_s, T * (1 + 1e-7));
    const Driven& same = share < 1 ? fixed : free;  // a tight budget is used completely, a slack one is not
    EXPECT_NEAR(budget.energy_J, same.energy_J, 1e-5 * same.energy_J) << share;
    EXPECT_NEAR(budget.duration_s, same.duration_s, 3e-3 * same.duration_s) << share;
  }
  double before_s = free.duration_s;
  for (double price_W : {1.0, 5.0, 25.0}) {
    const Driven priced = in({.mode = TimeMode::time_price, .price_W = price_W});
    EXPECT_LT(priced.duration_s, before_s) << price_W;
    EXPECT_GE(priced.duration_s, least.duration_s * (1 - 1e-6)) << price_W;
    EXPECT_LE(priced.energy_J + price_W * priced.duration_s,
              (free.energy_J + price_W * free.duration_s) * (1 + 1e-6));
    before_s = priced.duration_s;
  }
}

/// dE/dT from two plans beside each other.
TEST_P(EverySolver, ThePriceOfASecondIsTheSlopeOfTheEnergy) {
  // On one fine grid: energies on different grids differ by less than the requested accuracy, but the slope
  // would contain that difference.
  const auto in = [&](TimeGoal time) {
    ProfileRequest request = request_for(time, GetParam());
    request.nodes = 400;
    return drive(request);
  };
  const auto slope_W = [&](double T) {
    constexpr double h = 0.03;
    return (in({.mode = TimeMode::fixed_time, .duration_s = T - h}).energy_J -
            in({.mode = TimeMode::fixed_time, .duration_s = T + h}).energy_J) /
           (2 * h);
  };
  const Driven free = in({.mode = TimeMode::free_time});
  EXPECT_NEAR(slope_W(free.duration_s), 0, 0.05) << "another second of motion saves what standby costs";
  constexpr double kPrice_W = 2;
  const Driven priced = in({.mode = TimeMode::time_price, .price_W = kPrice_W});
  EXPECT_NEAR(priced.price_W, kPrice_W, 1e-9);
  EXPECT_NEAR(slope_W(priced.duration_s), kPrice_W, 0.02 * kPrice_W);
  for (TimeMode mode : {TimeMode::fixed_time, TimeMode::time_budget}) {
    const Driven same = in({.mode = mode, .duration_s = priced.duration_s});
    EXPECT_NEAR(same.price_W, kPrice_W, 1e-3 * kPrice_W) << "multiplier of the time";
  }
}

TEST_P(EverySolver, SpeedsAtTheEndsAreKept) {
  for (TimeGoal time : {TimeGoal{.mode = TimeMode::minimum_time},
                        {.mode = TimeMode::free_time},
                        {.mode = TimeMode::fixed_time, .duration_s = 9.5},
                        {.mode = TimeMode::time_price, .price_W = 5}}) {
    ProfileRequest request = request_for(time, GetParam());
    request.start_rate = 0.4;
    request.end_rate = 0.25;
    const ProfileResult result = solve_profile(request);
    ASSERT_TRUE(result.profile) << result.summary.message;
    EXPECT_NEAR(result.profile->rate.front(), 0.4, 1e-12);
    EXPECT_NEAR(result.profile->rate.back(), 0.25, 1e-12);
    EXPECT_EQ(result.profile->wait_s, 0) << "there is no waiting at speed";
    EXPECT_TRUE(replay(request, *result.profile).valid());
  }
}

INSTANTIATE_TEST_SUITE_P(Modes, EverySolver, ::testing::Values(SolverChoice::fast, SolverChoice::ipopt),
                         [](const auto& one) {
                           return std::string(one.param == SolverChoice::fast ? "fast" : "ipopt");
                         });

/// From 0.4 to 0.25 m/s over 6 m: up to 1 m/s at 0.5 m/s^2, cruise, down.
TEST(Modes, LeastTimeBetweenTwoSpeedsIsTheClosedForm) {
  ProfileRequest request = request_for({.mode = TimeMode::minimum_time});
  request.piece = straight_piece({}, 6);
  request.start_rate = 0.4;
  request.end_rate = 0.25;
  const double ramps_m = (1 - 0.4 * 0.4) + (1 - 0.25 * 0.25), ramps_s = (0.6 + 0.75) / 0.5;
  EXPECT_NEAR(drive(request).duration_s, ramps_s + 6 - ramps_m, 1e-3);
}

/// Energy by the transcription on the profile's own nodes, standby included.
double transcribed_J(const ProfileRequest& request, const Profile& profile) {
  const PathMotion motion = path_motion(request);
  const nlp::Problem problem = nlp::transcribe(request, motion, profile.s, {}, &profile);
  std::vector<double> b;
  for (double rate : profile.rate) b.push_back(rate * rate);
  double sum_J = request.plant.robot.power.standby_W * profile.duration_s();
  for (double energy_J : nlp::counted_energy_J(problem, b)) sum_J += energy_J;
  return sum_J;
}

TEST(Modes, ProgramAndReplayAgreeToTheAccuracyAsked) {
  ProfileRequest request = request_for({.mode = TimeMode::free_time});
  std::vector<CurveSegment> segments{LinearCurvature({}, 1.0)};  // a corner of radius 0.3 m
  const auto append = [&](double length_m, double curvature, double slope) {
    const Pose end = std::visit([](const auto& s) { return s.at(s.length_m()).pose; }, segments.back());
    segments.emplace_back(LinearCurvature(end, length_m, curvature, slope));
  };
  append(0.4, 0, 1 / 0.3 / 0.4);
  append(0.4, 1 / 0.3, -1 / 0.3 / 0.4);
  append(1.0, 0, 0);
  request.piece = Curve(std::move(segments));
  request.nodes = 12;
  double coarse = 0;
  std::size_t nodes = 0;
  for (double accuracy : {1e-2, 1e-3, 1e-4, 1e-5}) {
    request.accuracy = accuracy;
    const ProfileResult result = solve_profile(request);
    ASSERT_TRUE(result.profile) << result.summary.message;
    const ReplayResult again = replay(request, *result.profile);
    EXPECT_TRUE(again.valid()) << again.limit;
    const double error = std::abs(transcribed_J(request, *result.profile) / again.energy_J - 1);
    EXPECT_LE(error, 1.05 * accuracy) << accuracy;
    if (accuracy == 1e-2) coarse = error, nodes = result.summary.nodes;
    if (accuracy == 1e-5) {
      EXPECT_GT(result.summary.nodes, nodes) << "a finer grid for finer accuracy";
    }
  }
  EXPECT_GT(coarse, 1e-4) << "a grid this coarse has to be refined";
}

/// The control is constant on each segment: direct collocation of order 2 in the number of segments. The time
/// is so long that no limit is active: one that the path touches between nodes is held with a reserve.
TEST(Modes, TwiceTheNodesLeaveAQuarterOfTheExcessOfEnergy) {
  ProfileRequest request = request_for({.mode = TimeMode::fixed_time, .duration_s = 14});
  request.accuracy = 0.1;  // no grid is refined
  const auto energy_J = [&](std::size_t nodes) {
    request.nodes = nodes;
    return drive(request).energy_J;
  };
  const double least_J = energy_J(2000);
  double before_J = energy_J(20) - least_J;
  for (std::size_t nodes : {40, 80}) {
    const double excess_J = energy_J(nodes) - least_J;
    EXPECT_GT(before_J / excess_J, 3.0) << nodes;
    EXPECT_LT(before_J / excess_J, 5.0) << nodes;
    before_J = excess_J;
  }
}

/// Downhill the battery takes energy up: the accuracy is relative to its size.
TEST(Modes, AGridIsNotRefinedBecauseTheEnergyIsNegative) {
  ProfileRequest request = request_for({.mode = TimeMode::time_budget, .duration_s = 40});
  request.plant.robot.power.regeneration_efficiency = 1;
  request.piece = straight_piece({}, 8);
  request.plant = make_plant(
      request.plant.robot,
      {{.name = "floor_slope", .parameters = {{"grade", 0.3}, {"uphill_direction_rad", std::numbers::pi}}}});
  const ProfileResult result = solve_profile(request);
  ASSERT_TRUE(result.profile) << result.summary.message;
  EXPECT_LT(replay(request, *result.profile).energy_J, -1.0);
  EXPECT_LT(result.summary.nodes, 2 * request.nodes);
}

}  // namespace
}  // namespace joulepath
