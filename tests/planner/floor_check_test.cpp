#include "planner/legs/floor_check.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "planner/mission/mission.hpp"
#include "tests/planner/path/grids.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

const BezierPoints kAhead{{{0, 0}, {2, 0}, {4, 0}, {6, 0}}};  // in the robot's frame

/// A hall of 10 x 10 m with a wall of one cell across it, x from 5.0 to 5.1 m.
MissionWorld walled_world() {
  MissionWorld world{.robot = testing::nomad(), .map = free_grid(100, 100, 0.1)};
  world.robot.footprint = {0, {{-0.3, -0.25}, {0.4, -0.25}, {0.4, 0.25}, {-0.3, 0.25}}};
  for (std::size_t row = 0; row < 100; ++row) world.map->occupancy_percent[row * 100 + 50] = 100;
  return world;
}

MissionRequest along(PathRequest path, const Pose& start) {
  MissionRequest mission{.name = "given"};
  mission.start.pose = start;
  mission.legs.push_back({.path = std::move(path)});
  return mission;
}

Plan plan_of(const MissionRequest& mission, const MissionWorld& world) {
  return plan_mission(mission, world, {.solver = SolverChoice::fast, .nodes = 40, .baselines = false});
}

TEST(FloorCheck, AGivenPathThroughAWallIsRefusedWithPlaceAndDepth) {
  const Plan plan = plan_of(along({.bezier_m = {kAhead}}, {2, 3, 0}), walled_world());
  ASSERT_EQ(plan.status, SolveStatus::infeasible);
  ASSERT_TRUE(plan.infeasibility);
  const Infeasibility& reason = plan.infeasibility->reason;
  EXPECT_EQ(reason.constraint, "path");
  EXPECT_NEAR(reason.amount, 0.25, 0.06) << "half of the robot's width, to half a cell";
  EXPECT_NEAR(reason.x_m - 2, plan.infeasibility->arc_length_m, 1e-6);
  EXPECT_NEAR(reason.y_m, 3, 1e-9);
  EXPECT_NE(reason.message.find("blocked from 2.6"), std::string::npos) << reason.message;
}

TEST(FloorCheck, TheSamePathIsPlannedWhereItIsFree) {
  EXPECT_LE(plan_of(along({.bezier_m = {kAhead}}, {2, 3, M_PI / 2}), walled_world()).status,
            SolveStatus::feasible);
}

TEST(FloorCheck, APathOffTheMapOrThroughAKeepoutIsRefused) {
  MissionWorld world = walled_world();
  const Plan off = plan_of(along({.bezier_m = {kAhead}}, {2, 8, M_PI / 2}), world);
  ASSERT_EQ(off.status, SolveStatus::infeasible);
  EXPECT_NE(off.message.find("the map's edge"), std::string::npos) << off.message;
  world.keepout = free_grid(100, 100, 0.1);
  world.keepout->occupancy_percent[60 * 100 + 20] = 100;
  const Plan kept_out = plan_of(along({.bezier_m = {kAhead}}, {2, 3, M_PI / 2}), world);
  ASSERT_EQ(kept_out.status, SolveStatus::infeasible);
  EXPECT_NE(kept_out.message.find("the keep-out area"), std::string::npos) << kept_out.message;
}

TEST(FloorCheck, AClearanceThatIsMissedIsRelaxedToOneThatIsKept) {
  const MissionWorld world = walled_world();
  MissionRequest mission = along({.bezier_m = {kAhead}}, {4.7, 1, M_PI / 2});  // 5 cm beside the wall
  mission.clearance_m = 0.08;
  const Plan plan = plan_of(mission, world);
  ASSERT_EQ(plan.status, SolveStatus::infeasible);
  EXPECT_NEAR(plan.infeasibility->reason.amount, 0.03, 1e-6);
  mission.clearance_m = plan.infeasibility->reason.relaxation.at("clearance_m");
  EXPECT_NEAR(mission.clearance_m, 0.05, 2e-4);
  EXPECT_LE(plan_of(mission, world).status, SolveStatus::feasible);
}

TEST(FloorCheck, ATurnInPlaceIsSwept) {
  // A truck beside the wall: it can stand along the wall, but not turn away from it.
  MissionWorld world = walled_world();
  world.robot.footprint = {0, {{-0.2, -0.25}, {1.4, -0.25}, {1.4, 0.25}, {-0.2, 0.25}}};
  Path turn;
  append_turn_to(turn, {4.5, 5, M_PI / 2}, -M_PI / 2 + 1e-3);  // through 0: towards the wall
  const Plan plan = plan_of(along({.ready = turn}, turn.start()), world);
  ASSERT_EQ(plan.status, SolveStatus::infeasible);
  EXPECT_EQ(plan.infeasibility->arc_length_m, 0);
  EXPECT_GT(plan.infeasibility->reason.amount, 0.2);
}

TEST(FloorCheck, APrescribedMotionIsCheckedAgainstTheFloor) {
  MissionRequest mission{.name = "ramp"};
  mission.start.pose = {2, 3, 0};
  mission.legs.push_back({.motion = PrescribedMotion{.profile = MotionProfile::trapezoid,
                                                     .acceleration_m_s2 = 0.2,
                                                     .speed_m_s = 0.5,
                                                     .distance_m = 6}});
  const Plan plan = plan_of(mission, walled_world());
  ASSERT_EQ(plan.status, SolveStatus::infeasible);
  EXPECT_EQ(plan.infeasibility->reason.constraint, "path");
  EXPECT_NEAR(plan.infeasibility->reason.x_m - 2, plan.infeasibility->arc_length_m, 1e-3);
  mission.start.pose.heading_rad = M_PI / 2;
  EXPECT_LE(plan_of(mission, walled_world()).status, SolveStatus::feasible);
}

TEST(FloorCheck, CoordinatesOfTheMapInTheRobotsFrameGetAHint) {
  const BezierPoints on_map{{{2, 3}, {2, 5}, {2, 6}, {2, 8}}};
  const auto hint_of = [&](PathRequest path, const Pose& start) {
    try {
      return plan_of(along(std::move(path), start), walled_world()).message;
    } catch (const ConfigError& error) {
      return error.detail().hint;
    }
  };
  EXPECT_NE(hint_of({.bezier_m = {on_map}}, {2, 3, M_PI / 2}).find("`frame: map`?"), std::string::npos);
  EXPECT_NE(
      hint_of({.bezier_m = {kAhead}, .frame = PathRequest::Frame::map}, {2, 3, 0}).find("`frame: start`"),
      std::string::npos);
  const BezierPoints far{{{200, 3}, {202, 3}, {203, 3}, {204, 3}}};
  EXPECT_EQ(hint_of({.bezier_m = {far}}, {2, 3, 0}), "");
}

}  // namespace
}  // namespace joulepath
