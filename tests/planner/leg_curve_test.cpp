#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <numbers>
#include <random>
#include <vector>

#include "planner/mission/mission.hpp"
#include "tests/planner/path/grids.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

const PlanOptions kQuick{.solver = SolverChoice::fast, .nodes = 100, .accuracy = 1e-3, .baselines = false};

MissionWorld empty_floor() { return {.robot = testing::nomad(), .map = free_grid(400, 400, 0.1)}; }

MissionRequest to_goal(const Pose& start, const Point2& goal_m, std::optional<double> heading_rad = {}) {
  MissionRequest mission{.name = "pose", .clearance_m = 0.05};
  mission.stations["goal"] = {.x_m = goal_m[0], .y_m = goal_m[1], .heading_rad = heading_rad};
  mission.start.pose = start;
  mission.legs = {{.to = "goal"}};
  return mission;
}

/// Energy of the mission along a given path.
double along_J(MissionRequest mission, const Path& path) {
  mission.legs = {{.to = "goal", .path = PathRequest{.ready = path}}};
  return plan_mission(mission, empty_floor(), kQuick).energy.total_J();
}

double planned_J(const MissionRequest& mission) {
  return plan_mission(mission, empty_floor(), kQuick).energy.total_J();
}

Path one_bezier(const Pose& start, const BezierPoints& points_m) {
  std::vector<BezierPoints> map_m{points_m};
  for (Point2& point : map_m.front()) point = {start.x_m + point[0], start.y_m + point[1]};
  return Path{{Curve({BezierSegment(map_m.front())})}};
}

// Control points set by hand: one cubic that leaves in the robot's heading and swings around.
TEST(LegCurve, IsNoDearerThanOneHandSetBezierCurve) {
  const Pose back{20, 20, 150 * std::numbers::pi / 180};
  const MissionRequest behind = to_goal(back, {24, 20});
  const double swung_J = planned_J(behind);
  EXPECT_LE(swung_J,
            1.002 * along_J(behind, one_bezier(back, {{{0, 0}, {-0.122, 0.0704}, {0.082, 0.973}, {4, 0}}})));
  const Pose aside{20, 20, std::numbers::pi / 2};
  const MissionRequest left = to_goal(aside, {26, 20});
  EXPECT_LE(planned_J(left),
            1.002 * along_J(left, one_bezier(aside, {{{0, 0}, {0, 0.805}, {3.925, 0.134}, {6, 0}}})));
}

// Where the goal lies behind the robot, points between its heading and the goal lie on one line: every curve
// through them has a cusp. The curve has to swing aside. The hand-set ones bend at up to 39 per metre, the
// search's own at 25 at most: over 5 m this costs up to 0.25 %.
TEST(LegCurve, SwingsRoundToAGoalBehindTheRobot) {
  for (const double turn_deg : {172.0, -176.0, 179.0})
    for (const double reach_m : {1.5, 2.0, 5.0}) {
      const double heading_rad = turn_deg * std::numbers::pi / 180, side = turn_deg < 0 ? 1 : -1;
      const Pose start{20, 20, heading_rad};
      const MissionRequest behind = to_goal(start, {20 + reach_m, 20});
      const Path hand_set = one_bezier(start, {{{0, 0},
                                                {0.14 * std::cos(heading_rad), 0.14 * std::sin(heading_rad)},
                                                {0.0, -side * 0.7},
                                                {reach_m, 0}}});
      EXPECT_LE(planned_J(behind), (reach_m > 2 ? 1.004 : 1.002) * along_J(behind, hand_set))
          << turn_deg << ", " << reach_m;
    }
}

// The same with the goal's heading asked: both ends swing.
TEST(LegCurve, SwingsRoundAtBothEnds) {
  for (const double heading_rad : {-3.05, 3.0}) {
    const Plan plan = plan_mission(to_goal({20, 20, 3.1}, {22.5, 20}, heading_rad), empty_floor(), kQuick);
    for (const StretchPlan& stretch : plan.legs.front().stretches)
      EXPECT_FALSE(is_turn(stretch.request.piece)) << heading_rad;
  }
}

// Also where the cheapest way with a lead along the start's heading is already a curve, curves straight to
// the goal are tried. A brute-force search over splines finds 84.7 J; turning in place takes 99.4 J.
TEST(LegCurve, IsTriedFromTheStraightLineWhereALeadIsCheaperThanATurn) {
  const MissionRequest mission = to_goal({20, 20, 2.07096}, {18.25321, 19.31798}, 1.07146);
  const Plan plan = plan_mission(mission, empty_floor(), kQuick);
  EXPECT_LE(plan.energy.total_J(), 86.5);
  for (const StretchPlan& stretch : plan.legs.front().stretches) EXPECT_FALSE(is_turn(stretch.request.piece));
}

TEST(LegCurve, IsNeverDearerThanTurnLineTurnAndArrivesInTheHeadingAsked) {
  std::mt19937 random(11);
  std::uniform_real_distribution<> angle(-std::numbers::pi, std::numbers::pi), reach(0.3, 6.0);
  for (int trial = 0; trial < 10; ++trial) {
    const Pose start{20, 20, angle(random)};
    const double bearing_rad = angle(random), reach_m = reach(random), heading_rad = angle(random);
    const Point2 goal_m{20 + reach_m * std::cos(bearing_rad), 20 + reach_m * std::sin(bearing_rad)};
    const std::optional<double> asked = trial % 2 ? std::optional(heading_rad) : std::nullopt;
    Path plain;
    append_turn_to(plain, start, bearing_rad);
    plain.pieces.push_back(straight_piece({20, 20, bearing_rad}, reach_m));
    if (asked) append_turn_to(plain, plain.end(), *asked);
    const MissionRequest mission = to_goal(start, goal_m, asked);
    const Plan plan = plan_mission(mission, empty_floor(), kQuick);
    ASSERT_FALSE(plan.infeasibility) << plan.message;
    EXPECT_LE(plan.energy.total_J(), along_J(mission, plain) * (1 + 1e-4)) << trial;
    const PathPiece& first = plan.legs[0].stretches.front().request.piece;
    const PathPiece& last = plan.legs[0].stretches.back().request.piece;
    const Pose end = piece_point(last, piece_length(last)).pose;
    EXPECT_NEAR(wrapped_angle_rad(piece_point(first, 0).pose.heading_rad - start.heading_rad), 0, 1e-9);
    EXPECT_NEAR(std::hypot(end.x_m - goal_m[0], end.y_m - goal_m[1]), 0, 1e-6);
    if (asked) {
      EXPECT_NEAR(wrapped_angle_rad(end.heading_rad - *asked), 0, 1e-9);
    }
  }
}

TEST(LegCurve, AStopWithoutAHeadingIsLeftAsItIsReached) {
  MissionRequest mission = to_goal({20, 20, 1.0}, {20.5, 25});
  mission.stations["middle"] = {.x_m = 24, .y_m = 21};
  mission.legs = {{.to = "middle"}, {.to = "goal"}};
  const Plan plan = plan_mission(mission, empty_floor(), kQuick);
  ASSERT_EQ(plan.legs.size(), 2u) << plan.message;
  PlanOptions turning = kQuick;
  turning.steps.refinement = false;
  const Plan turned = plan_mission(mission, empty_floor(), turning);
  EXPECT_LT(plan.energy.total_J(), 0.97 * turned.energy.total_J());
  EXPECT_LT(plan.legs[0].turned_rad + plan.legs[1].turned_rad, 1e-6);
}

/// Answers that planning a mission needs, counted in a folder that keeps them all.
std::ptrdiff_t answers_for(const MissionRequest& mission) {
  const auto folder =
      std::filesystem::path(::testing::TempDir()) / ("leg_curve_answers_" + std::to_string(getpid()));
  AnswerCache kept(folder.string());
  PlanOptions options = kQuick;
  options.answers.cache = &kept;
  (void)plan_mission(mission, empty_floor(), options);
  const auto is_file = [](const auto& entry) { return entry.is_regular_file(); };
  using Files = std::filesystem::recursive_directory_iterator;
  const std::ptrdiff_t count = std::count_if(Files(folder), Files(), is_file);
  std::filesystem::remove_all(folder);
  return count;
}

/// The search through stops replaces the curves of both legs: only the last curve of a leg gets a profile
/// with certificate, so that a stop more adds few answers (9 where every curve that is taken gets one).
TEST(LegCurve, IsCheckedBetweenTheNodesOncePerLeg) {
  MissionRequest two = to_goal({20, 20, 1.0}, {20.5, 25}), three = two;
  two.stations["a"] = three.stations["a"] = {.x_m = 24, .y_m = 21};
  three.stations["b"] = {.x_m = 26, .y_m = 25};
  two.legs = {{.to = "a"}, {.to = "goal"}};
  three.legs = {{.to = "a"}, {.to = "b"}, {.to = "goal"}};
  EXPECT_LE(answers_for(three) - answers_for(two), 5);
}

/// Two legs through Nav2's depot, with one payload on both.
MissionRequest through_the_depot(double payload_kg) {
  MissionRequest mission = to_goal({1.29, 1.65, std::numbers::pi / 2}, {5.61, 13.88}, -std::numbers::pi / 2);
  mission.stations["stop"] = {.x_m = 10.36, .y_m = 3.32};
  const PayloadAlongLeg payload{payload_kg, payload_kg};
  mission.legs = {{.to = "stop", .payload = payload}, {.to = "goal", .payload = payload}};
  return mission;
}

/// The same along the paths of a plan.
MissionRequest along_paths_of(MissionRequest mission, const Plan& plan) {
  for (std::size_t k = 0; k < mission.legs.size(); ++k) {
    Path path;
    for (const StretchPlan& stretch : plan.legs[k].stretches) path.pieces.push_back(stretch.request.piece);
    mission.legs[k].path = PathRequest{.ready = std::move(path)};
  }
  return mission;
}

/// The search has found a curve for another payload that suits this one better only where it ended in a worse
/// local optimum: with three polished guesses, plans here are 1.9 % above such a path.
TEST(LegCurve, IsNotMuchDearerThanAPathFoundForAnotherPayload) {
  const MissionWorld world{.robot = testing::nomad(), .map = nav2_depot()};
  ASSERT_TRUE(world.map);
  const double payloads_kg[] = {0, 6, 10};
  std::vector<Plan> plans;
  for (const double payload_kg : payloads_kg)
    plans.push_back(plan_mission(through_the_depot(payload_kg), world, kQuick));
  for (std::size_t p = 0; p < plans.size(); ++p)
    for (std::size_t q = 0; q < plans.size(); ++q) {
      if (p == q) continue;
      ASSERT_EQ(plans[q].legs.size(), 2u) << plans[q].message;
      const Plan other =
          plan_mission(along_paths_of(through_the_depot(payloads_kg[p]), plans[q]), world, kQuick);
      EXPECT_LE(plans[p].energy.total_J(), 1.005 * other.energy.total_J()) << p << ", " << q;
    }
}

TEST(LegCurve, KeepsItsClearanceFromAWallBesideTheStart) {
  // A wall half a metre to the left of a robot that must turn by half a turn in either direction.
  MissionWorld world = empty_floor();
  for (int row = 206; row < 400; ++row)
    for (int column = 0; column < 400; ++column)
      world.map->occupancy_percent[static_cast<std::size_t>(row * 400 + column)] = 100;
  const Plan plan = plan_mission(to_goal({20, 20, 0.0}, {16, 20}), world, kQuick);
  ASSERT_FALSE(plan.infeasibility) << plan.message;
  const RouteSpace space(*world.map, nullptr, world.robot.footprint, 0.05);
  for (const StretchPlan& stretch : plan.legs[0].stretches)
    EXPECT_FALSE(space.checker().first_collision(stretch.request.piece));
}

}  // namespace
}  // namespace joulepath
