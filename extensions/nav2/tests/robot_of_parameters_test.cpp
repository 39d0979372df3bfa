#include "extensions/nav2/robot_of_parameters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "scenarios/robot_files/robot_sources.hpp"
#include "tests/scenarios/scratch_directory.hpp"

namespace joulepath {
namespace {

std::map<std::string, std::string> values_in(const RobotDraft& draft) {
  std::map<std::string, std::string> values;
  for (const DraftValue& value : draft.values) values[value.key] = value.text;
  return values;
}

TEST(RobotOfParameters, LimitsWheelsAndFootprintWithTheirLines) {
  const ScratchDirectory scratch;
  const RobotDraft draft = draft_from({scratch.write("params.yaml", R"(velocity_smoother:
  ros__parameters:
    max_velocity: [0.4, 0.0, 1.2]
    max_accel: [0.6, 0.0, 2.0]
    max_decel: [-0.7, 0.0, -2.0]
local_costmap:
  local_costmap:
    ros__parameters:
      footprint: "[[0.3, 0.2], [-0.2, 0.2], [-0.2, -0.2], [0.3, -0.2]]"
diff_drive_controller:
  ros__parameters:
    wheel_separation: 0.34
    wheel_radius: 0.08
)")},
                                      {});
  auto values = values_in(draft);
  EXPECT_EQ(values["limits.speed_m_s"], "0.4");
  EXPECT_EQ(values["limits.deceleration_m_s2"], "0.7");
  EXPECT_EQ(values["limits.yaw_rate_rad_s"], "1.2");
  EXPECT_EQ(values["geometry.half_track_m"], "0.17");
  EXPECT_EQ(values["geometry.wheel_radius_m"], "0.08");
  EXPECT_EQ(values["footprint.polygon_m"], "[[0.3, 0.2], [-0.2, 0.2], [-0.2, -0.2], [0.3, -0.2]]");
  const auto acceleration =
      std::ranges::find(draft.values, std::string("limits.acceleration_m_s2"), &DraftValue::key);
  ASSERT_NE(acceleration, draft.values.end());
  EXPECT_NE(acceleration->origin.find("params.yaml line 4"), std::string::npos);
}

/// As the controller drives: its multipliers, its braking where none is stated, its speed in reverse; the
/// namespaces around a node change nothing.
TEST(RobotOfParameters, WheelsAndBrakingAreThoseOfTheController) {
  const ScratchDirectory scratch;
  const std::string node = R"(diff_drive_controller:
  ros__parameters:
    wheel_separation: 0.4
    wheel_separation_multiplier: 1.5
    wheel_radius: 0.1
    left_wheel_radius_multiplier: 0.9
    right_wheel_radius_multiplier: 0.8
    linear.x.max_velocity: 1.0
    linear.x.min_velocity: -0.3
    linear.x.max_acceleration: 0.5
)";
  std::string inside = "/**:\n  ";
  for (const char c : node) inside += c == '\n' ? std::string("\n  ") : std::string(1, c);
  for (const std::string& text : {node, inside}) {
    auto values = values_in(draft_from({scratch.write("params.yaml", text)}, {}));
    EXPECT_EQ(values["geometry.half_track_m"], "0.3");
    EXPECT_EQ(values["geometry.wheel_radius_m"], "{left: 0.09, right: 0.08}");
    EXPECT_EQ(values["limits.deceleration_m_s2"], "0.5");
    EXPECT_EQ(values["limits.reverse_speed_m_s"], "0.3");
  }
}

/// Of a controller that only drives forward there is no speed in reverse; old ones brake with positive
/// values.
TEST(RobotOfParameters, SignsOfLeastSpeedsAndDecelerations) {
  const ScratchDirectory scratch;
  const auto with = [&](const std::string& parameters) {
    return values_in(draft_from(
        {scratch.write("params.yaml",
                       "controller_server:\n  ros__parameters:\n    FollowPath: {" + parameters + "}\n")},
        {}));
  };
  auto forward = with("max_vel_x: 0.5, min_vel_x: 0.0, acc_lim_x: 1.0, decel_lim_x: -2.0");
  EXPECT_FALSE(forward.contains("limits.reverse_speed_m_s"));
  EXPECT_EQ(forward["limits.deceleration_m_s2"], "2");
  auto both = values_in(draft_from(
      {scratch.write(
          "params.yaml",
          "controller_server:\n  ros__parameters:\n    FollowPath: {max_vel_x: 0.5, min_vel_x: 0.0}\n"
          "velocity_smoother:\n  ros__parameters: {max_velocity: [0.4, 0, 1], min_velocity: [-0.26, 0, "
          "-1]}\n")},
      {}));
  EXPECT_FALSE(both.contains("limits.reverse_speed_m_s")) << "the controller drives forward alone";
  EXPECT_FALSE(with("vx_max: 0.5, vx_min: 0.1").contains("limits.reverse_speed_m_s"));
  EXPECT_EQ(with("vx_max: 0.5, vx_min: -0.35")["limits.reverse_speed_m_s"], "0.35");
  for (const char* decel : {"0.2", "-0.2"})
    EXPECT_EQ(with(std::string("desired_linear_vel: 0.5, max_linear_accel: 0.3, max_linear_decel: ") +
                   decel)["limits.deceleration_m_s2"],
              "0.2");
}

TEST(RobotOfParameters, AnEmptyFootprintIsNone) {
  const ScratchDirectory scratch;
  const auto values_with = [&](const std::string& local, const std::string& global) {
    return values_in(draft_from(
        {scratch.write("params.yaml", "local_costmap: {local_costmap: {ros__parameters: {" + local +
                                          "}}}\nglobal_costmap: {global_costmap: {ros__parameters: {" +
                                          global + "}}}\nwheels: {ros__parameters: {wheel_radius: 0.08}}\n")},
        {}));
  };
  const std::string triangle = "footprint: \"[[0.3, 0], [-0.2, 0.2], [-0.2, -0.2]]\"";
  EXPECT_EQ(values_with("footprint: \"[]\", robot_radius: 0.22", triangle)["footprint.radius_m"], "0.22");
  EXPECT_EQ(values_with("footprint: \"[[0.1, 0], [0.2, 0]]\"", triangle)["footprint.polygon_m"],
            "[[0.3, 0], [-0.2, 0.2], [-0.2, -0.2]]");
}

TEST(RobotOfParameters, RmfFleetsGiveLimitsMassBatteryAndPower) {
  const ScratchDirectory scratch;
  auto values = values_in(draft_from({scratch.write("config.yaml", R"(rmf_fleet:
  name: mover
  limits: {linear: [0.6, 0.8], angular: [0.7, 1.9]}
  profile: {footprint: 0.35, vicinity: 0.5}
  battery_system: {voltage: 24.0, capacity: 30.0, charging_current: 8.0}
  mechanical_system: {mass: 45.0, moment_of_inertia: 4.0, friction_coefficient: 0.02}
  ambient_system: {power: 25.0}
  recharge_threshold: 0.15
)")},
                                     {}));
  EXPECT_EQ(values["limits.speed_m_s"], "0.6");
  EXPECT_EQ(values["limits.yaw_acceleration_rad_s2"], "1.9");
  EXPECT_EQ(values["inertia.chassis_mass_kg"], "45");
  EXPECT_EQ(values["inertia.chassis_yaw_inertia_kg_m2"], "4");
  EXPECT_EQ(values["effects"], "rolling_resistance: {coefficient: 0.02}");
  EXPECT_EQ(values["battery.capacity_Wh"], "720");
  EXPECT_EQ(values["battery.reserve_fraction"], "0.15");
  EXPECT_EQ(values["power.standby_W"], "25");
  EXPECT_EQ(values["footprint.radius_m"], "0.35");
}

}  // namespace
}  // namespace joulepath
