// Poses, times, energies and the battery's charge of a plan follow each other without a jump, in every
// export: the robot cannot be elsewhere at the next instant, whatever legs do not drive.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "extensions/bags/bag_export.hpp"
#include "extensions/vda5050/order_json.hpp"
#include "model/watt_hours.hpp"
#include "planner/accounts/edge_energy.hpp"
#include "planner/accounts/plan_trajectory.hpp"
#include "planner/mission/mission.hpp"
#include "planner/path/geometry/path.hpp"
#include "scenarios/log_files/run_log.hpp"
#include "tests/scenarios/scratch_directory.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::json;

constexpr double kFastest_m_s = 1.0, kFastest_rad_s = 2.0;  // of the robot
constexpr double kMostPower_W = 400;                        // 8 A at 24 V on both sides

struct PlannedMission {
  std::string name{};
  MissionRequest mission{};
  MissionWorld world{};
  Plan plan{};
  Plant plant{};
};

/// A free floor of 24 m x 24 m.
OccupancyGrid floor_without_walls() {
  OccupancyGrid grid{.width = 120, .height = 120, .resolution_m = 0.2};
  grid.occupancy_percent.assign(120 * 120, 0);
  return grid;
}

PlannedMission planned(const std::string& name, MissionRequest mission) {
  PlannedMission result{.name = name, .mission = std::move(mission), .world = {.robot = testing::nomad()}};
  if (!result.mission.stations.empty()) result.world.map = floor_without_walls();
  const PlanOptions options{.solver = SolverChoice::fast, .nodes = 40, .accuracy = 1e-3, .baselines = false};
  result.plan = plan_mission(result.mission, result.world, options);
  result.plant = make_plant(result.world.robot);
  return result;
}

LegRequest stay(double dwell_s) { return {.path = PathRequest{.ready = Path{}}, .dwell_s = dwell_s}; }

LegRequest along(const Pose& from, double length_m) {
  Path path;
  path.pieces.push_back(straight_piece(from, length_m));
  return {.path = PathRequest{.ready = path}, .payload = {5, 5}};
}

LegRequest prescribed(double distance_m) {
  return {.motion = PrescribedMotion{.profile = MotionProfile::trapezoid,
                                     .acceleration_m_s2 = 0.25,
                                     .speed_m_s = 0.5,
                                     .distance_m = distance_m}};
}

/// Stays at the start, between legs and at the end; an order names its paths like this.
MissionRequest stays_along_given_paths() {
  MissionRequest mission{.name = "given"};
  mission.start.pose = {3, 4, 0.5};
  mission.start.heading_given = true;
  const Pose middle{3 + 2 * std::cos(0.5), 4 + 2 * std::sin(0.5), 0.5};
  mission.legs = {stay(2), along(mission.start.pose, 2), stay(3), along(middle, 1.5), stay(1)};
  mission.legs[1].duration_s = 20;  // longer than it needs: a wait within the leg
  return mission;
}

MissionRequest stays_beside_a_prescribed_motion() {
  MissionRequest mission{.name = "prescribed"};
  mission.start.pose = {-2, 1, 2.5};
  mission.start.heading_given = true;
  mission.legs = {stay(2), prescribed(1.5), stay(3), prescribed(2)};
  mission.legs[1].dwell_s = 1;
  return mission;
}

MissionRequest stays_at_stations(bool heading_given) {
  MissionRequest mission{.name = "stations"};
  mission.stations = {{"a", {.x_m = 8, .y_m = 6}}, {"b", {.x_m = 13, .y_m = 9}}};
  mission.start = {.station = "a", .pose = {8, 6, 1.0}, .heading_given = heading_given};
  mission.legs = {{.to = "a", .dwell_s = 2}, {.to = "b"}, {.to = "b", .dwell_s = 3}, {.to = "a"}};
  return mission;
}

MissionRequest motion_before_a_way() {
  MissionRequest mission = stays_at_stations(false);
  mission.legs = {prescribed(2), {.to = "b", .dwell_s = 1}};
  return mission;
}

const std::vector<PlannedMission>& plans() {
  static const std::vector<PlannedMission> all{
      planned("given paths", stays_along_given_paths()),
      planned("prescribed", stays_beside_a_prescribed_motion()),
      planned("stations", stays_at_stations(true)),
      planned("stations, free heading", stays_at_stations(false)),
      planned("a motion before a way", motion_before_a_way()),
      planned("stays only", {.name = "stays", .start = {.pose = {5, -7, 1}}, .legs = {stay(2), stay(1)}})};
  return all;
}

/// A row of an export.
struct Row {
  double time_s{}, x_m{}, y_m{}, heading_rad{};
};

void expect_continuous(const std::vector<Row>& rows, double duration_s, const std::string& what) {
  ASSERT_FALSE(rows.empty()) << what;
  EXPECT_NEAR(rows.back().time_s, duration_s, 1e-6) << what;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const Row &from = rows[k - 1], &to = rows[k];
    const double dt = to.time_s - from.time_s;
    EXPECT_GE(dt, 0) << what << " row " << k;
    ASSERT_LE(std::hypot(to.x_m - from.x_m, to.y_m - from.y_m), kFastest_m_s * dt + 1e-5) << what << " " << k;
    ASSERT_LE(std::abs(wrapped_angle_rad(to.heading_rad - from.heading_rad)), kFastest_rad_s * dt + 1e-5)
        << what << " row " << k;
  }
}

std::vector<Row> rows_of(const Trajectory& motion) {
  std::vector<Row> rows;
  for (std::size_t k = 0; k < motion.size(); ++k)
    rows.push_back({motion.time_s[k], motion.position_x_m[k], motion.position_y_m[k], motion.heading_rad[k]});
  return rows;
}

/// The stamped poses of a ROS message.
std::vector<Row> rows_of(const Json& list) {
  std::vector<Row> rows;
  for (const Json& entry : list) {
    const Json& pose = entry["pose"].contains("pose") ? entry["pose"]["pose"] : entry["pose"];
    const Json& stamp = entry["header"]["stamp"];
    rows.push_back(
        {stamp["sec"].get<double>() + 1e-9 * stamp["nanosec"].get<double>(), pose["position"]["x"],
         pose["position"]["y"],
         2 * std::atan2(pose["orientation"]["z"].get<double>(), pose["orientation"]["w"].get<double>())});
  }
  return rows;
}

TEST(ContinuousPlan, RowsOfEveryExportFollowEachOtherAndTheStartIsTheMissions) {
  const ScratchDirectory scratch;
  for (const PlannedMission& plan : plans()) {
    ASSERT_LE(plan.plan.status, SolveStatus::feasible) << plan.name << ": " << plan.plan.message;
    const ExportInput input{plan.mission, plan.world, plan.plan, plan.plant, scratch.at("x.json"), {}};
    const double duration_s = plan.plan.duration_s;
    const Trajectory motion = plan_trajectory(plan.plan, plan.plant);
    expect_continuous(rows_of(motion), duration_s, plan.name + ", trajectory.csv");
    expect_continuous(rows_of(plan_nodes(plan.plan, plan.plant).rows), duration_s,
                      plan.name + ", profile.csv");
    expect_continuous(rows_of(Json::parse(export_nav2_path(input).files[0].content)["poses"]), duration_s,
                      plan.name + ", nav2_path");
    expect_continuous(rows_of(Json::parse(export_trajectory(input).files[0].content)["points"]), duration_s,
                      plan.name + ", trajectory");
    const std::string bag = scratch.write("plan.mcap", export_bag(input).files[0].content);
    expect_continuous(rows_of(read_run_log(bag, plan.world.robot.geometry).trajectory), duration_s,
                      plan.name + ", bag");
    const Pose& start = plan.mission.start.pose;
    EXPECT_NEAR(motion.position_x_m[0], start.x_m, 1e-9) << plan.name;
    EXPECT_NEAR(motion.position_y_m[0], start.y_m, 1e-9) << plan.name;
  }
}

TEST(ContinuousPlan, RowsOfEdgesBeginWhereTheOnesBeforeEnd) {
  for (const PlannedMission& plan : plans()) {
    const std::vector<EdgeEnergy> edges = edge_energies(plan.plan, plan.plant);
    ASSERT_FALSE(edges.empty());
    EXPECT_NEAR(edges[0].from.x_m, plan.mission.start.pose.x_m, 1e-9) << plan.name;
    double now_s = 0;
    for (std::size_t k = 0; k < edges.size(); ++k) {
      EXPECT_NEAR(edges[k].start_s, now_s, 1e-9) << plan.name << " row " << k;
      now_s += edges[k].duration_s;
      if (k == 0) continue;
      const Pose &end = edges[k - 1].to, &begin = edges[k].from;
      EXPECT_NEAR(begin.x_m, end.x_m, 1e-6) << plan.name << " row " << k;
      EXPECT_NEAR(begin.y_m, end.y_m, 1e-6) << plan.name << " row " << k;
      EXPECT_NEAR(wrapped_angle_rad(begin.heading_rad - end.heading_rad), 0, 1e-6)
          << plan.name << " row " << k;
    }
    EXPECT_NEAR(now_s, plan.plan.duration_s, 1e-9) << plan.name;
  }
}

TEST(ContinuousPlan, EnergyAndChargeFollowEachOther) {
  for (const PlannedMission& plan : plans()) {
    const Trajectory motion = plan_trajectory(plan.plan, plan.plant);
    for (std::size_t k = 1; k < motion.size(); ++k)
      ASSERT_LE(std::abs(motion.energy_J[k] - motion.energy_J[k - 1]),
                kMostPower_W * (motion.time_s[k] - motion.time_s[k - 1]) + 1e-6)
          << plan.name << " row " << k;
    ASSERT_TRUE(plan.plan.battery) << plan.name;
    const BatteryAccount& battery = *plan.plan.battery;
    double charge_J =
        (battery.start_fraction - battery.end_fraction) * plan.plant.robot.battery.capacity_Wh * kJoulesPerWh;
    EXPECT_NEAR(charge_J, plan.plan.energy.total_J() + battery.loss_J, 1e-6 * charge_J) << plan.name;
    EXPECT_EQ(battery.fraction_after_leg.back(), battery.end_fraction) << plan.name;
  }
}

TEST(ContinuousPlan, AnOrderBeginsWhereThePlanDoes) {
  const ScratchDirectory scratch;
  for (const PlannedMission& plan : plans()) {
    if (std::any_of(plan.plan.legs.begin(), plan.plan.legs.end(),
                    [](const LegPlan& leg) { return leg.prescribed.has_value(); }))
      continue;
    const ExportInput input{plan.mission, plan.world, plan.plan, plan.plant, scratch.at("o.json"), {}};
    const Json order = Json::parse(export_vda5050(input).files[0].content);
    const Json& place = order["nodes"][0]["nodePosition"];
    const Trajectory motion = plan_trajectory(plan.plan, plan.plant);
    EXPECT_NEAR(place["x"].get<double>(), motion.position_x_m[0], 1e-9) << plan.name;
    EXPECT_NEAR(place["theta"].get<double>(), wrapped_angle_rad(motion.heading_rad[0]), 1e-9) << plan.name;
  }
}

}  // namespace
}  // namespace joulepath
