#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "planner/mission/mission.hpp"
#include "planner/path/geometry/path.hpp"
#include "scenarios/export/exports.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath::testing {

inline constexpr double kFastest_m_s = 1.0, kFastest_rad_s = 2.0;  // of the robot

struct PlannedMission {
  std::string name{};
  MissionRequest mission{};
  MissionWorld world{};
  Plan plan{};
  Plant plant{};

  ExportInput input(const std::string& file) const { return {mission, world, plan, plant, file, {}}; }
};

/// A free floor of 24 m x 24 m.
inline OccupancyGrid floor_without_walls() {
  OccupancyGrid grid{.width = 120, .height = 120, .resolution_m = 0.2};
  grid.occupancy_percent.assign(120 * 120, 0);
  return grid;
}

inline PlannedMission planned(const std::string& name, MissionRequest mission) {
  PlannedMission result{.name = name, .mission = std::move(mission), .world = {.robot = nomad()}};
  if (!result.mission.stations.empty()) result.world.map = floor_without_walls();
  const PlanOptions options{.solver = SolverChoice::fast, .nodes = 40, .accuracy = 1e-3, .baselines = false};
  result.plan = plan_mission(result.mission, result.world, options);
  result.plant = make_plant(result.world.robot);
  return result;
}

inline LegRequest stay(double dwell_s) { return {.path = PathRequest{.ready = Path{}}, .dwell_s = dwell_s}; }

inline LegRequest along(const Pose& from, double length_m) {
  Path path;
  path.pieces.push_back(straight_piece(from, length_m));
  return {.path = PathRequest{.ready = path}, .payload = {5, 5}};
}

inline LegRequest prescribed(double distance_m) {
  return {.motion = PrescribedMotion{.profile = MotionProfile::trapezoid,
                                     .acceleration_m_s2 = 0.25,
                                     .speed_m_s = 0.5,
                                     .distance_m = distance_m}};
}

/// Stays at the start, between legs and at the end; an order names its paths like this.
inline MissionRequest stays_along_given_paths() {
  MissionRequest mission{.name = "given"};
  mission.start.pose = {3, 4, 0.5};
  mission.start.heading_given = true;
  const Pose middle{3 + 2 * std::cos(0.5), 4 + 2 * std::sin(0.5), 0.5};
  mission.legs = {stay(2), along(mission.start.pose, 2), stay(3), along(middle, 1.5), stay(1)};
  mission.legs[1].duration_s = 20;  // longer than it needs: a wait within the leg
  return mission;
}

inline MissionRequest stays_beside_a_prescribed_motion() {
  MissionRequest mission{.name = "prescribed"};
  mission.start.pose = {-2, 1, 2.5};
  mission.start.heading_given = true;
  mission.legs = {stay(2), prescribed(1.5), stay(3), prescribed(2)};
  mission.legs[1].dwell_s = 1;
  return mission;
}

inline MissionRequest stays_at_stations(bool heading_given) {
  MissionRequest mission{.name = "stations"};
  mission.stations = {{"a", {.x_m = 8, .y_m = 6}}, {"b", {.x_m = 13, .y_m = 9}}};
  mission.start = {.station = "a", .pose = {8, 6, 1.0}, .heading_given = heading_given};
  mission.legs = {{.to = "a", .dwell_s = 2}, {.to = "b"}, {.to = "b", .dwell_s = 3}, {.to = "a"}};
  return mission;
}

inline MissionRequest motion_before_a_way() {
  MissionRequest mission = stays_at_stations(false);
  mission.legs = {prescribed(2), {.to = "b", .dwell_s = 1}};
  return mission;
}

/// Turns by more than a full circle: arcs to either side, turns in place, stays between them.
inline MissionRequest full_circles() {
  const auto arc = [](double angle_rad) {
    return LegRequest{.motion = PrescribedMotion{.profile = MotionProfile::arc,
                                                 .acceleration_m_s2 = 0.3,
                                                 .speed_m_s = 0.6,
                                                 .radius_m = 1.5,
                                                 .angle_rad = angle_rad}};
  };
  const LegRequest spin{.motion = PrescribedMotion{.profile = MotionProfile::spin,
                                                   .angle_rad = 2.5,
                                                   .yaw_rate_rad_s = 1.0,
                                                   .yaw_acceleration_rad_s2 = 1.0}};
  MissionRequest mission{.name = "circles"};
  mission.start.pose = {1, 1, 3.0};
  mission.start.heading_given = true;
  mission.legs = {arc(7.5), stay(1), arc(-14.0), stay(1), spin, spin, spin, stay(1)};
  return mission;
}

/// A loop of curves to the left, twice around: each piece states its heading within one turn.
inline MissionRequest loops() {
  MissionRequest mission{.name = "loops"};
  mission.start.pose = {0, 0, 0};
  const std::vector<BezierPoints> circle{{{{0, 0}, {1.1, 0}, {2, 0.9}, {2, 2}}},
                                         {{{2, 2}, {2, 3.1}, {1.1, 4}, {0, 4}}},
                                         {{{0, 4}, {-1.1, 4}, {-2, 3.1}, {-2, 2}}},
                                         {{{-2, 2}, {-2, 0.9}, {-1.1, 0}, {0, 0}}}};
  for (int k = 0; k < 2; ++k)
    mission.legs.push_back({.path = PathRequest{.bezier_m = circle, .frame = PathRequest::Frame::map}});
  return mission;
}

inline const std::vector<PlannedMission>& continuous_plans() {
  static const std::vector<PlannedMission> all{
      planned("given paths", stays_along_given_paths()),
      planned("prescribed", stays_beside_a_prescribed_motion()),
      planned("stations", stays_at_stations(true)),
      planned("stations, free heading", stays_at_stations(false)),
      planned("a motion before a way", motion_before_a_way()),
      planned("full circles", full_circles()),
      planned("loops", loops()),
      planned("stays only", {.name = "stays", .start = {.pose = {5, -7, 1}}, .legs = {stay(2), stay(1)}})};
  return all;
}

/// A row of an export.
struct Row {
  double time_s{}, x_m{}, y_m{}, heading_rad{};
};

/// `wraps`: orientations that know no full turns.
inline void expect_continuous(const std::vector<Row>& rows, double duration_s, const std::string& what,
                              bool wraps = false) {
  ASSERT_FALSE(rows.empty()) << what;
  EXPECT_NEAR(rows.back().time_s, duration_s, 1e-6) << what;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const Row &from = rows[k - 1], &to = rows[k];
    const double dt = to.time_s - from.time_s;
    EXPECT_GE(dt, 0) << what << " row " << k;
    ASSERT_LE(std::hypot(to.x_m - from.x_m, to.y_m - from.y_m), kFastest_m_s * dt + 1e-5) << what << " " << k;
    const double turned_rad = to.heading_rad - from.heading_rad;
    ASSERT_LE(std::abs(wraps ? wrapped_angle_rad(turned_rad) : turned_rad), kFastest_rad_s * dt + 1e-5)
        << what << " row " << k;
  }
}

inline std::vector<Row> rows_of(const Trajectory& motion) {
  std::vector<Row> rows;
  for (std::size_t k = 0; k < motion.size(); ++k)
    rows.push_back({motion.time_s[k], motion.position_x_m[k], motion.position_y_m[k], motion.heading_rad[k]});
  return rows;
}

/// The stamped poses of a ROS message.
inline std::vector<Row> rows_of(const nlohmann::json& list) {
  std::vector<Row> rows;
  for (const nlohmann::json& entry : list) {
    const nlohmann::json& pose = entry["pose"].contains("pose") ? entry["pose"]["pose"] : entry["pose"];
    const nlohmann::json& stamp = entry["header"]["stamp"];
    rows.push_back(
        {stamp["sec"].get<double>() + 1e-9 * stamp["nanosec"].get<double>(), pose["position"]["x"],
         pose["position"]["y"],
         2 * std::atan2(pose["orientation"]["z"].get<double>(), pose["orientation"]["w"].get<double>())});
  }
  return rows;
}

}  // namespace joulepath::testing
