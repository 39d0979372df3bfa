#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "extensions/vda5050/order_mission.hpp"
#include "extensions/vda5050/order_path.hpp"
#include "planner/mission/mission.hpp"
#include "planner/motion/path_motion.hpp"
#include "scenarios/any_file.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/mission_files/mission_source.hpp"
#include "tests/scenarios/scratch_directory.hpp"

namespace joulepath {
namespace {

using std::numbers::pi;

std::string node(int sequence, double x_m, double y_m, const std::string& more = "",
                 const std::string& actions = "") {
  return "{\"nodeId\": \"n" + std::to_string(sequence) + "\", \"sequenceId\": " + std::to_string(sequence) +
         ", \"released\": true, \"nodePosition\": {\"x\": " + std::to_string(x_m) +
         ", \"y\": " + std::to_string(y_m) + ", \"mapId\": \"m\"" + more + "}, \"actions\": [" + actions +
         "]}";
}

std::string edge(int sequence, const std::string& more = "") {
  return "{\"edgeId\": \"e" + std::to_string(sequence) + "\", \"sequenceId\": " + std::to_string(sequence) +
         ", \"released\": true, \"actions\": []" + more + "}";
}

std::string order(const std::string& nodes, const std::string& edges, const std::string& version = "3.0.0") {
  return "{\"version\": \"" + version + "\", \"orderId\": \"o\", \"nodes\": [" + nodes + "], \"edges\": [" +
         edges + "]}";
}

MissionRequest mission_of(const std::string& file) {
  MissionRequest mission{.order_file = file};
  follow_order(mission);
  return mission;
}

const Path& path_of(const MissionRequest& mission, std::size_t leg = 0) {
  return *mission.legs.at(leg).path->ready;
}

TEST(Order, AMissionWithAnOrderNeedsNoMap) {
  const ScratchDirectory scratch;
  (void)scratch.write("order.json", order(node(0, 0, 0) + "," + node(2, 3, 0), edge(1)));
  const std::string file =
      scratch.write("mission.yaml", "schema: joulepath/mission/1\nrobot: robot.yaml\norder: order.json\n");
  EXPECT_EQ(read_mission(file).legs.size(), 1u);
}

TEST(Order, AllVersionsGiveTheSameMission) {
  const ScratchDirectory scratch;
  const std::string v2 = scratch.write(
      "2.json",
      order(node(0, 0, 0) + "," + node(2, 3, 0, ", \"allowedDeviationXY\": 0.1") + "," + node(4, 3, 2),
            edge(1, ", \"maxSpeed\": 0.4") + "," + edge(3, ", \"maxRotationSpeed\": 0.2"), "2.1.0"));
  const std::string v1 = scratch.write(
      "1.json",
      order(node(0, 0, 0) + "," + node(2, 3, 0, ", \"allowedDeviationXY\": 0.1") + "," + node(4, 3, 2),
            edge(1, ", \"maxSpeed\": 0.4") + "," + edge(3), "1.1.1"));
  EXPECT_EQ(path_of(mission_of(v1)).distance_m(), path_of(mission_of(v2)).distance_m());
  EXPECT_EQ(mission_of(v1).speed_zones.at(0).speed_m_s, 0.4);
  EXPECT_THROW((void)mission_of(scratch.write("0.json", order(node(0, 0, 0), "", "1.0.0"))), ConfigError);
  const std::string v3 = scratch.write(
      "3.json", order(node(0, 0, 0) + "," +
                          node(2, 3, 0, ", \"allowedDeviationXY\": {\"a\": 0.3, \"b\": 0.1, \"theta\": 0}") +
                          "," + node(4, 3, 2),
                      edge(1, ", \"maximumSpeed\": 0.4") + "," + edge(3, ", \"maximumRotationSpeed\": 0.2")));
  const MissionRequest two = mission_of(v2), three = mission_of(v3);
  ASSERT_EQ(two.legs.size(), 1u);
  ASSERT_EQ(three.legs.size(), 1u);
  EXPECT_EQ(path_of(two).distance_m(), path_of(three).distance_m());
  EXPECT_EQ(two.speed_zones.at(0).speed_m_s, 0.4);
  EXPECT_EQ(three.speed_zones.at(0).speed_m_s, 0.4);
  EXPECT_EQ(two.speed_zones[0].to_m, three.speed_zones[0].to_m);
  EXPECT_EQ(two.legs[0].yaw_rate_rad_s, 0.2);
  EXPECT_EQ(three.legs[0].yaw_rate_rad_s, 0.2);
}

TEST(Order, CircleOfARationalTrajectoryHasItsRadius) {
  const ScratchDirectory scratch;
  const std::string file = scratch.write(
      "o.json",
      order(node(0, 1, 0) + "," + node(2, 0, 1),
            edge(1,
                 ", \"trajectory\": {\"degree\": 2, \"knotVector\": [0, 0, 0, 1, 1, 1], \"controlPoints\": "
                 "[{\"x\": 1, \"y\": 0}, {\"x\": 1, \"y\": 1, \"weight\": 0.70710678118654752}, "
                 "{\"x\": 0, \"y\": 1}]}")));
  const MissionRequest mission = mission_of(file);
  ASSERT_EQ(path_of(mission).pieces.size(), 1u);
  const PathPiece& arc = path_of(mission).pieces[0];
  EXPECT_NEAR(piece_length(arc), pi / 2, 1e-10);
  for (int i = 0; i <= 50; ++i) {
    const PathPoint point = piece_point(arc, piece_length(arc) * i / 50);
    EXPECT_NEAR(std::hypot(point.pose.x_m, point.pose.y_m), 1, 1e-10);
    EXPECT_NEAR(point.curvature_per_m, 1, 1e-8);
  }
}

TEST(Order, CornersStayWithinWhatTheNodeAllows) {
  constexpr double kDeviation_m = 0.2;
  const ScratchDirectory scratch;
  const auto bent = [&](const std::string& deviation) {
    return mission_of(
        scratch.write("o.json", order(node(0, 0, 0) + "," + node(2, 3, 0, deviation) + "," + node(4, 3, 2) +
                                          "," + node(6, 5, 2, deviation) + "," + node(8, 5, 5),
                                      edge(1) + "," + edge(3) + "," + edge(5) + "," + edge(7))));
  };
  const MissionRequest blended = bent(", \"allowedDeviationXY\": 0.2"), turned = bent("");
  EXPECT_EQ(path_of(turned).pieces.size(), 7u);
  EXPECT_NEAR(path_of(turned).turned_rad(), 1.5 * pi, 1e-9);
  // The node between the two that allow a deviation allows none: a turn in place.
  ASSERT_EQ(path_of(blended).pieces.size(), 3u);
  const PathPiece& first = path_of(blended).pieces[0];
  double nearest_m = 1e9;
  for (int i = 0; i <= 2000; ++i) {
    const Pose pose = piece_point(first, piece_length(first) * i / 2000).pose;
    nearest_m = std::min(nearest_m, std::hypot(pose.x_m - 3, pose.y_m));
  }
  EXPECT_NEAR(nearest_m, kDeviation_m, 1e-3);
  const auto& parts = blended.legs[0].parts;
  ASSERT_EQ(parts.size(), 4u);
  EXPECT_NEAR(parts.back().to_m, path_of(blended).distance_m(), 1e-9);
  for (std::size_t k = 0; k + 1 < parts.size(); ++k) EXPECT_EQ(parts[k].to_m, parts[k + 1].from_m);
}

TEST(Order, AgainstTheEdgeIsDrivenInReverse) {
  const ScratchDirectory scratch;
  const auto end_heading = [&](const std::string& orientation) {
    const MissionRequest mission =
        mission_of(scratch.write("o.json", order(node(0, 0, 0) + "," + node(2, 0, 2), edge(1, orientation))));
    EXPECT_EQ(path_of(mission).pieces.size(), 1u);
    return std::pair{travel_sign(path_of(mission).pieces[0]), path_of(mission).end().heading_rad};
  };
  EXPECT_EQ(end_heading("").first, 1);
  EXPECT_EQ(end_heading(", \"orientation\": 3.14159").first, -1);
  const auto global = end_heading(", \"orientation\": -1.5708, \"orientationType\": \"GLOBAL\"");
  EXPECT_EQ(global.first, -1);
  EXPECT_NEAR(wrapped_angle_rad(global.second + pi / 2), 0, 1e-6);
}

TEST(Order, TheRobotTurnsToTheHeadingOfANode) {
  const ScratchDirectory scratch;
  const MissionRequest mission = mission_of(
      scratch.write("o.json", order(node(0, 0, 0) + "," + node(2, 2, 0, ", \"theta\": 1.5"), edge(1))));
  EXPECT_NEAR(path_of(mission).end().heading_rad, 1.5, 1e-12);
  EXPECT_NEAR(path_of(mission).turned_rad(), 1.5, 1e-12);
}

TEST(Order, DurationOfActionsFollowsTheirBlockingType) {
  using Blocking = OrderAction::Blocking;
  const auto action = [](Blocking blocking, double duration_s) {
    return OrderAction{.type = "a", .blocking = blocking, .duration_s = duration_s};
  };
  EXPECT_EQ(standing_s({action(Blocking::none, 9), action(Blocking::single, 9)}, {}), 0);
  EXPECT_EQ(standing_s({action(Blocking::soft, 3), action(Blocking::soft, 5)}, {}), 5);
  EXPECT_EQ(standing_s({action(Blocking::soft, 3), action(Blocking::hard, 5)}, {}), 8);
  EXPECT_EQ(standing_s({action(Blocking::hard, 3), action(Blocking::none, 5), action(Blocking::soft, 4)}, {}),
            7);
  EXPECT_EQ(standing_s({action(Blocking::none, 6), action(Blocking::hard, 1)}, {}), 7);
  EXPECT_EQ(standing_s({{.type = "a", .blocking = Blocking::hard}}, {{"a", 4}}), 4);
}

TEST(Order, LegsEndAtActionsAndCarryTheirPayload) {
  const ScratchDirectory scratch;
  const auto hard = [](const std::string& type) {
    return "{\"actionType\": \"" + type + "\", \"actionId\": \"1\", \"blockingType\": \"HARD\"}";
  };
  MissionRequest mission{
      .order_file = scratch.write(
          "o.json", order(node(0, 0, 0) + "," + node(2, 1, 0) + "," + node(4, 2, 0, "", hard("pick")) + "," +
                              node(6, 3, 0, "", hard("drop")) + "," + node(8, 4, 0),
                          edge(1) + "," + edge(3) + "," + edge(5) + "," + edge(7))),
      .payload_by_action = {{"pick", 5.0}},
      .dwell_by_action_s = {{"pick", 10.0}, {"drop", 4.0}}};
  follow_order(mission);
  ASSERT_EQ(mission.legs.size(), 3u);
  EXPECT_EQ(mission.legs[0].to, "n4");
  EXPECT_NEAR(path_of(mission, 0).distance_m(), 2, 1e-12);
  const double payloads_kg[] = {0, 5, 0}, dwells_s[] = {10, 4, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(mission.legs[k].payload.from_kg, payloads_kg[k]);
    EXPECT_EQ(mission.legs[k].dwell_s, dwells_s[k]);
  }
}

TEST(Order, TheOnlyNodeIsReachedFromTheRobotsPose) {
  const ScratchDirectory scratch;
  const std::string file = scratch.write("o.json", order(node(0, 3, 1), ""));
  MissionRequest mission{.order_file = file};
  EXPECT_THROW(follow_order(mission), ConfigError);
  mission.marks.keys["start"] = {};
  mission.start.pose = {1.0, 1.0, 0.5};
  follow_order(mission);
  ASSERT_EQ(mission.legs.size(), 1u);
  EXPECT_EQ(mission.legs[0].to, "n0");
  EXPECT_FALSE(mission.legs[0].path.has_value());
  EXPECT_EQ(mission.stations.at("n0").x_m, 3);
  EXPECT_EQ(mission.start.pose.x_m, 1);
}

TEST(Order, AtItsOnlyNodeARobotTurnsToItsHeading) {
  const ScratchDirectory scratch;
  const auto mission_from_heading = [&](double heading_rad, const std::string& actions) {
    MissionRequest mission{
        .order_file = scratch.write("o.json", order(node(0, 3, 1, ", \"theta\": 1.5", actions), ""))};
    mission.marks.keys["start"] = {};
    mission.start.pose = {3.0, 1.0, heading_rad};
    mission.start.heading_given = true;
    follow_order(mission);
    return mission;
  };
  const std::string pick =
      R"({"actionType": "pick", "actionId": "1", "blockingType": "HARD",
          "actionParameters": [{"key": "duration", "value": 5}]})";
  EXPECT_FALSE(mission_from_heading(0.0, pick).legs.at(0).path.has_value());
  const MissionRequest stands = mission_from_heading(1.5, pick);
  EXPECT_TRUE(stands.legs.at(0).path.has_value());
  EXPECT_EQ(stands.legs.at(0).dwell_s, 5);
  try {
    (void)mission_from_heading(1.5, "");
    ADD_FAILURE();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("a base of one node"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("o.json:1:"), std::string::npos);
  }
}

TEST(Order, AnOrderOfOneNodeIsValid) {
  const ScratchDirectory scratch;
  EXPECT_EQ(read_any_file(scratch.write("o.json", order(node(0, 3, 1), ""))).text,
            "1 node, reached from where the robot stands");
}

TEST(Order, CoordinatesThatLookLikeMillimetersAreDoubted) {
  const ScratchDirectory scratch;
  const auto notes = [&](double step) {
    return order_notes(read_order(
        scratch.write("o.json", order(node(0, 0, 0) + "," + node(2, step, 0) + "," + node(4, 2 * step, 0),
                                      edge(1) + "," + edge(3)))));
  };
  EXPECT_TRUE(notes(30).empty());
  EXPECT_EQ(notes(2500).size(), 1u);
}

TEST(Order, HorizonIsNotPlanned) {
  const ScratchDirectory scratch;
  std::string horizon = node(4, 9, 0) + "", last = edge(3);
  for (std::string* text : {&horizon, &last}) text->replace(text->find("true"), 4, "false");
  const MissionRequest mission = mission_of(scratch.write(
      "o.json", order(node(0, 0, 0) + "," + node(2, 1, 0) + "," + horizon, edge(1) + "," + last)));
  ASSERT_EQ(mission.legs.size(), 1u);
  EXPECT_EQ(mission.legs[0].to, "n2");
}

/// The shipped order, planned: every limit of its edges holds everywhere.
TEST(Order, PlanKeepsTheLimitsOfTheEdges) {
  MissionRequest mission =
      read_mission_source({.file = JOULEPATH_SOURCE_DIR "/scenarios/orders/warehouse_v3.json",
                           .robot_file = JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml"});
  const MissionWorld world = read_world(mission);
  const Plan plan =
      plan_mission(mission, world, {.solver = SolverChoice::fast, .nodes = 60, .accuracy = 1e-2});
  ASSERT_LE(plan.status, SolveStatus::feasible);
  double fastest_share = 0, quickest_share = 0;
  for (std::size_t k = 0; k < plan.legs.size(); ++k) {
    double offset_m = 0;
    for (const StretchPlan& stretch : plan.legs[k].stretches) {
      const bool turn = is_turn(stretch.request.piece);
      const PathMotion motion = path_motion(stretch.request);
      for (int i = 0; i <= 400; ++i) {
        const ProfileState state = stretch.profile.at_time(stretch.profile.duration_s() * i / 400);
        const double yaw_rate_rad_s = std::abs(motion.rates(state.s).turn * state.rate);
        quickest_share = std::max(quickest_share, yaw_rate_rad_s / *mission.legs[k].yaw_rate_rad_s);
        if (turn) continue;
        for (const SpeedZone& zone : mission.speed_zones)
          if (zone.leg == k && offset_m + state.s > zone.from_m + 1e-9 &&
              offset_m + state.s < zone.to_m - 1e-9)
            fastest_share = std::max(fastest_share, state.rate / zone.speed_m_s);
      }
      if (!turn) offset_m += piece_length(stretch.request.piece);
    }
  }
  EXPECT_LE(fastest_share, 1 + 1e-6);
  EXPECT_GT(fastest_share, 0.5);
  EXPECT_LE(quickest_share, 1 + 1e-6);
  EXPECT_GT(quickest_share, 0.9);
}

}  // namespace
}  // namespace joulepath
