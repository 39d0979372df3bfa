#include "app/jobs/cache_choice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "planner/mission/mission.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/mission_files/plan_file.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "tests/support/locations.hpp"

namespace joulepath {
namespace {

TEST(KeptAnswers, AnotherRobotOrFloorIsAnotherWorld) {
  const Robot robot = read_robot(JOULEPATH_SOURCE_DIR "/tests/data/broken/good/robot.yaml");
  MissionRequest mission{.clearance_m = 0.1};
  MissionWorld world{.robot = robot, .map = OccupancyGrid{2, 1, 0.1, {}, {0, 100}, "map"}};
  std::vector<ContentKey> keys;
  const auto note = [&](const Robot& with) { keys.push_back(world_key(floor_key(mission, world), with)); };
  note(robot);
  Robot other = robot;
  other.motor.right.friction_torque_Nm = std::nextafter(other.motor.right.friction_torque_Nm, 1.0);
  note(other);
  mission.clearance_m = 0.2;
  note(robot);
  world.map->occupancy_percent[0] = 1;
  note(robot);
  world.keepout = world.map;
  note(robot);
  world.speed_mask = SpeedMask{.grid = *world.map};
  note(robot);
  world.speed_mask->base = 50;
  note(robot);
  world.route_graph = RouteGraph{.nodes = {{1, 0, 0}}};
  note(robot);
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end());
}

/// If no way keeps a leg's own duration, ways that stop at corners are tried: the second choice is another
/// question to the cache.
TEST(KeptAnswers, OtherStepsAreCachedSeparately) {
  const MissionRequest mission = read_mission(JOULEPATH_SOURCE_DIR "/scenarios/missions/depot_round.yaml");
  const MissionWorld world = read_world(mission);
  AnswerCache kept;
  const auto energy_J = [&](const WaySteps& steps, AnswerCache* cache) {
    PlanOptions options{
        .solver = SolverChoice::fast, .nodes = 30, .accuracy = 1e-2, .steps = steps, .baselines = false};
    options.answers.cache = cache;
    return plan_mission(mission, world, options).energy.total_J();
  };
  const WaySteps plain{.corners = false, .stops = false, .refinement = false};
  const WaySteps arcs{.stops = false, .refinement = false};
  const double plain_J = energy_J(plain, nullptr), arcs_J = energy_J(arcs, nullptr);
  EXPECT_NE(plain_J, arcs_J);
  for (int again = 0; again < 2; ++again) {
    EXPECT_EQ(energy_J(plain, &kept), plain_J);
    EXPECT_EQ(energy_J(arcs, &kept), arcs_J);
  }
}

TEST(Plan, DoesNotDependOnThreadsOrCache) {
  const MissionRequest mission = read_mission(JOULEPATH_SOURCE_DIR "/scenarios/missions/depot_round.yaml");
  const MissionWorld world = read_world(mission);
  AnswerCache kept;
  const auto text = [&](unsigned threads, AnswerCache* cache) {
    PlanOptions options{.solver = SolverChoice::fast, .nodes = 30, .accuracy = 1e-2, .threads = threads};
    options.answers.cache = cache;
    return plan_json_text(plan_mission(mission, world, options));
  };
  const std::string plan = text(1, nullptr);
  EXPECT_EQ(text(2, nullptr), plan);
  EXPECT_EQ(text(2, &kept), plan);
  EXPECT_EQ(text(1, &kept), plan) << "from kept answers";
}

/// Other plans on the same floor, with the same cache and the same searched routes, change no byte.
TEST(Plan, DoesNotDependOnWhatWasPlannedBefore) {
  const MissionRequest mission = read_mission(JOULEPATH_SOURCE_DIR "/scenarios/missions/depot_round.yaml");
  const MissionWorld world = read_world(mission);
  const std::optional<RouteSpace> space = route_space(mission, world);
  AnswerCache kept;
  const auto text = [&](const MissionRequest& asked, unsigned seed, const RouteSpace* floor,
                        AnswerCache* cache) {
    PlanOptions options{
        .solver = SolverChoice::fast, .nodes = 30, .accuracy = 1e-2, .seed = seed, .baselines = false};
    options.answers.cache = cache;
    return plan_json_text(plan_mission(asked, world, options, floor));
  };
  const std::string cold = text(mission, 1, nullptr, nullptr);
  MissionRequest heavier = mission, sooner = mission;
  for (LegRequest& leg : heavier.legs) leg.payload.from_kg *= 1.1, leg.payload.to_kg *= 1.1;
  sooner.objective.minimize = Objective::Minimize::time;
  EXPECT_NE(text(heavier, 1, &*space, &kept), cold);
  text(mission, 2, &*space, &kept);  // may be the same plan
  EXPECT_NE(text(sooner, 1, &*space, &kept), cold);
  EXPECT_EQ(text(mission, 1, &*space, &kept), cold) << "after other plans";
  EXPECT_EQ(text(mission, 1, &*space, &kept), cold) << "from kept answers";
  EXPECT_EQ(text(mission, 1, &*space, nullptr), cold) << "from kept routes";
}

}  // namespace
}  // namespace joulepath
