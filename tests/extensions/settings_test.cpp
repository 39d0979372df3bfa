#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "extensions/nav2/controller_settings.hpp"
#include "extensions/nav2/exports.hpp"
#include "extensions/vda5050/order_json.hpp"
#include "planner/mission/mission.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "tests/scenarios/scratch_directory.hpp"

namespace joulepath {
namespace {

struct PlannedRound {
  MissionRequest mission{};
  MissionWorld world{};
  Plan plan{};
  Plant plant{};

  explicit PlannedRound(const std::string& robot, bool turns = false) {
    LegRequest there{.path = PathRequest{.bezier_m = {{{{0, 0}, {2, 0}, {4, 0}, {6, 0}}}}},
                     .payload = {5, 5}};
    LegRequest curve{.path = PathRequest{.bezier_m = {{{{0, 0}, {2.7, 0}, {2.7, 0}, {2.7, 2.7}}}}},
                     .payload = {5, 5}};
    mission = {.name = "round", .legs = {there, curve}};
    if (turns)
      mission.legs.push_back(
          {.path = PathRequest{.bezier_m = {{{{0, 0}, {-1, 0}, {-3, 0}, {-4, 0}}}}}, .payload = {1, 1}});
    mission.robot_file = JOULEPATH_SOURCE_DIR "/scenarios/robots/" + robot;
    world = read_world(mission);
    plan = plan_mission(mission, world, {.solver = SolverChoice::fast, .nodes = 60, .accuracy = 1e-3});
    plant = make_plant(world.robot);
  }
  ExportInput input(const std::string& file) const { return {mission, world, plan, plant, file, {}}; }
};

const PlannedRound& heavy() {
  static const PlannedRound planned("amr_150kg.yaml");
  return planned;
}

TEST(HeavyRobot, SettingsTakeThePlansTime) {
  struct Case {
    const char* name;
    Export (*write)(const ExportInput&);
  };
  for (const auto& [name, write] :
       {Case{"controller.json", export_controller}, Case{"settings.yaml", export_nav2_settings},
        Case{"order.json", export_vda5050}, Case{"mask.yaml", export_speed_mask}}) {
    const Export result = write(heavy().input(name));
    ASSERT_TRUE(result.loss) << name;
    EXPECT_TRUE(result.loss->plan_time) << name << " is later than the plan";
    EXPECT_LE(result.loss->own_time.duration_s, heavy().plan.duration_s * (1 + 1e-5)) << name;
    EXPECT_EQ(result.loss->broken_limit, "") << name;
    if (write != export_controller && write != export_nav2_settings) continue;
    // Not the robot's limits and a wait, which lost 14.5 %.
    EXPECT_GT(result.loss->own_time.duration_s, heavy().plan.duration_s - 0.01) << name;
    EXPECT_LT(result.loss->plan_time->lost_J(), 0.04 * heavy().plan.energy.total_J()) << name;
  }
}

/// A round with turns in place, so that settings of curves and of turns meet in one file.
const PlannedRound& with_turns(const std::string& robot) {
  static std::map<std::string, PlannedRound> planned;
  const auto found = planned.find(robot);
  if (found != planned.end()) return found->second;
  return planned.emplace(robot, PlannedRound(robot, true)).first->second;
}

TEST(Nav2Settings, CostWhatTheySayWhenReadBack) {
  const ScratchDirectory directory;
  for (const char* robot : {"amr_150kg.yaml", "nomad_super_scout.yaml"}) {
    const PlannedRound& round = with_turns(robot);
    ASSERT_TRUE(mission_settings(round.plan).turn);
    const Export written = export_nav2_settings(round.input("settings.yaml"));
    const std::string& text = written.files.at(0).content;
    EXPECT_EQ(text.find(" -0 J"), std::string::npos);
    const ControllerFile file = read_controller_settings(directory.write("settings.yaml", text));
    const ControllerLoss loss = loss_of(round.plan, drive_with(round.plan, file));
    EXPECT_NEAR(loss.own_time.duration_s, written.loss->own_time.duration_s, 1e-4) << robot;
    EXPECT_NEAR(loss.own_time.energy_J, written.loss->own_time.energy_J, 1e-5 * loss.own_time.energy_J);
    ASSERT_TRUE(loss.plan_time) << robot;
    char said[64];
    std::snprintf(said, sizeof said, "All sections: %.2f s, %.1f J", loss.own_time.duration_s,
                  loss.own_time.energy_J);
    EXPECT_NE(text.find(said), std::string::npos) << said << "\n" << text.substr(0, 300);
  }
}

/// There and back in reverse, which is slower: the file says what each direction may, and costs what it says.
TEST(Nav2Settings, ALimitInReverseDoesNotBindForward) {
  const ScratchDirectory directory;
  PlannedRound round("nomad_super_scout.yaml");
  Path back;
  back.pieces.push_back(Curve({LinearCurvature({6, 0, std::numbers::pi}, 4)}, Direction::reverse));
  round.mission.legs = {round.mission.legs.front(), {.path = PathRequest{.ready = back}}};
  round.world.robot.limits->reverse_speed_m_s = 0.3;
  round.plan = plan_mission(round.mission, round.world, {.solver = SolverChoice::fast, .nodes = 60});
  ASSERT_LE(round.plan.status, SolveStatus::feasible) << round.plan.message;
  const Export written = export_nav2_settings(round.input("settings.yaml"));
  const ControllerFile file =
      read_controller_settings(directory.write("settings.yaml", written.files.at(0).content));
  EXPECT_GT(*file.speed_m_s, 0.5);
  EXPECT_NEAR(*file.reverse_speed_m_s, 0.3, 1e-9);
  const ControllerLoss loss = loss_of(round.plan, drive_with(round.plan, file));
  EXPECT_NEAR(loss.own_time.energy_J, written.loss->own_time.energy_J, 1e-5 * loss.own_time.energy_J);
  EXPECT_LT(loss.own_time.duration_s, 1.05 * round.plan.duration_s);
}

TEST(ControllerFile, ReadsTheSettingsOfEachLegThatAnExportWrote) {
  const ScratchDirectory directory;
  for (const char* robot : {"amr_150kg.yaml", "nomad_super_scout.yaml"}) {
    const PlannedRound& round = with_turns(robot);
    const Export written = export_controller(round.input("controller.json"));
    const ControllerFile file =
        read_controller_settings(directory.write("controller.json", written.files.at(0).content));
    const ControlledDrive drive = drive_with(round.plan, file);
    EXPECT_NEAR(drive.duration_s, written.loss->own_time.duration_s, 1e-6) << robot;
    EXPECT_NEAR(drive.energy_J, written.loss->own_time.energy_J, 1e-6 * drive.energy_J) << robot;
  }
  ControllerFile one_leg;
  one_leg.legs.resize(1);
  EXPECT_THROW((void)drive_with(heavy().plan, one_leg), ConfigError);
}

/// A slow change of the yaw rate makes a robot slow in curves, and not on straight lines.
TEST(ControllerFile, YawAccelerationSlowsCurves) {
  const ScratchDirectory directory;
  const auto drive = [&](const std::string& yaw_acceleration) {
    return drive_with(heavy().plan, read_controller_settings(directory.write(
                                        "p.yaml", "FollowPath: {az_max: " + yaw_acceleration + "}\n")));
  };
  const ControlledDrive slow = drive("0.1"), free = drive("2.0");
  EXPECT_GT(slow.stretch_s.back(), 1.2 * free.stretch_s.back());
  EXPECT_NEAR(slow.stretch_s.front(), free.stretch_s.front(), 1e-6);
}

TEST(ControllerFile, TheLeastOfSeveralNodesHolds) {
  const ScratchDirectory directory;
  const ControllerFile file =
      read_controller_settings(directory.write("nav2.yaml",
                                               "velocity_smoother:\n"
                                               "  ros__parameters:\n"
                                               "    max_velocity: [0.5, 0.0, 2.0]\n"
                                               "    max_decel: [-0.4, 0.0, -3.2]\n"
                                               "controller_server:\n"
                                               "  ros__parameters:\n"
                                               "    FollowPath: {vx_max: 0.7, ax_max: 0.3}\n"
                                               "diff_drive_controller:\n"
                                               "  ros__parameters:\n"
                                               "    linear: {x: {max_velocity: 0.6}}\n"));
  EXPECT_EQ(file.speed_m_s, 0.5);
  EXPECT_EQ(file.acceleration_m_s2, 0.3);
  EXPECT_EQ(file.deceleration_m_s2, 0.4);
  EXPECT_EQ(file.yaw_rate_rad_s, 2.0);
}

TEST(ControllerFile, SlowerSettingsTakeLonger) {
  const ScratchDirectory directory;
  const auto drive = [&](const std::string& speed) {
    return drive_with(heavy().plan, read_controller_settings(directory.write(
                                        "p.yaml", "FollowPath: {desired_linear_vel: " + speed + "}\n")));
  };
  EXPECT_GT(drive("0.2").duration_s, drive("0.6").duration_s + 5);
}

TEST(ControllerFile, AbsurdSizesAndWrongSignsAreRefused) {
  const ScratchDirectory directory;
  const auto read = [&](const std::string& text) {
    return read_controller_settings(directory.write("p.yaml", text + "\n"));
  };
  for (const char* text :
       {"a: {vx_max: 1e-12}", "a: {vx_max: -0.5}", "a: {vx_max: 1e9}", "a: {max_decel: [0.4, 0.0, -1.0]}",
        "a: {ax_min: 0.3}", "a: {linear: {x: {max_velocity: 1e-12}}}", "a: {max_accel: [-0.4, 0.0, 1.0]}"})
    EXPECT_THROW((void)read(text), ConfigError) << text;
  EXPECT_EQ(read("a: {max_decel: [-0.4, 0.0, -1.0], max_velocity: [0.0, 0.0, 1.0]}").deceleration_m_s2, 0.4);
}

/// The message of a refusal; empty for a file that is read.
std::string refusal_of(const std::string& text) {
  const ScratchDirectory directory;
  try {
    (void)read_controller_settings(directory.write("p.yaml", text));
    return "";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

constexpr const char* kSmoother =
    "velocity_smoother: {ros__parameters: {max_velocity: [0.5, 0.0, 2.0], max_accel: [0.5, 0.0, 2.0], "
    "max_decel: [-0.5, 0.0, -2.0]}}\n";

/// A limit under a name that this reader does not know would leave the robot's own limit in force.
TEST(ControllerFile, ASpeedOfAnUnknownNameIsNamed) {
  for (const std::string key : {"linear_vel_max: 0.3", "max_decel_linear: -0.4", "cruise_speed: 0.3",
                                "max_trans_vel: 0.3", "linear_velocity: 0.3", "rotational_acc_lim: 1.0"}) {
    const std::string name = key.substr(0, key.find(':'));
    for (const std::string& text :
         {kSmoother +
              ("controller_server:\n  ros__parameters:\n    FollowPath:\n      plugin: some::Controller\n"
               "      " +
               key + "\n"),
          "FollowPath: {vx_max: 0.4, " + key + "}\n"}) {
      EXPECT_NE(refusal_of(text).find(name), std::string::npos) << text << refusal_of(text);
    }
  }
  EXPECT_NE(
      refusal_of("velocity_smoother: {ros__parameters: {max_velocity: [0.5, 0.0, 2.0], max_speed: [0.1, 0.0, "
                 "1.0]}}\n")
          .find("max_speed"),
      std::string::npos);
}

/// Keys that limit no drive forward are no reason to refuse the defaults of a controller.
TEST(ControllerFile, KeysOfOtherPurposesAreNotAsked) {
  for (const char* keys :
       {"desired_linear_vel: 0.4, min_approach_linear_velocity: 0.05, approach_velocity_scaling_dist: 1.0, "
        "regulated_linear_scaling_min_speed: 0.25, max_allowed_time_to_collision_up_to_carrot: 1.0, "
        "use_velocity_scaled_lookahead_dist: false",
        "max_vel_x: 0.4, min_vel_x: 0.0, max_vel_y: 0.0, max_speed_xy: 0.4, min_speed_xy: 0.0, "
        "min_speed_theta: "
        "0.0, acc_lim_y: 0.0, decel_lim_y: 0.0, trans_stopped_velocity: 0.25, vx_samples: 20",
        "vx_max: 0.4, vx_min: -0.35, vy_max: 0.5, vx_std: 0.2, wz_max: 1.9, temperature: 0.3"}) {
    const ScratchDirectory directory;
    const std::string text =
        "controller_server: {ros__parameters: {min_x_velocity_threshold: 0.001, "
        "controller_plugins: [FollowPath], goal_checker: {plugin: "
        "nav2_controller::StoppedGoalChecker, trans_stopped_velocity: 0.1}, FollowPath: {plugin: "
        "a::B, " +
        std::string(keys) + "}}}\n";
    EXPECT_EQ(refusal_of(text), "");
    EXPECT_EQ(read_controller_settings(directory.write("p.yaml", text)).speed_m_s, 0.4) << keys;
  }
}

TEST(ControllerFile, SeveralControllersThatDriveAreListed) {
  const std::string two = "FollowPath: {plugin: a::B, vx_max: 0.8}, Docking: {plugin: a::B, vx_max: 0.05}";
  for (const std::string& text :
       {"controller_server: {ros__parameters: {controller_plugins: [FollowPath, Docking], " + two + "}}\n",
        "robot1: {controller_server: {ros__parameters: {" + two + "}}}\n", "{" + two + "}\n"}) {
    EXPECT_NE(refusal_of(text).find("FollowPath"), std::string::npos) << text;
    EXPECT_NE(refusal_of(text).find("Docking"), std::string::npos) << text;
  }
  const ScratchDirectory directory;
  const std::string one =
      "controller_server: {ros__parameters: {controller_plugins: [FollowPath], " + two + "}}\n";
  EXPECT_EQ(read_controller_settings(directory.write("p.yaml", one)).speed_m_s, 0.8);
}

/// Nodes that do not drive the robot have keys of the same names.
TEST(ControllerFile, OtherNodesAreLeftOut) {
  const ScratchDirectory directory;
  for (const char* other : {"dwb_unused: {ros__parameters: {max_vel_x: 0.05}}",
                            "arm_controller: {ros__parameters: {max_velocity: [0.1, "
                            "0.1, 0.1]}}",
                            "docking_server: {ros__parameters: {controller: {v_linear_max: 0.15}}}",
                            "behavior_server: {ros__parameters: {max_rotational_vel: 0.1, FollowPath: "
                            "{desired_linear_vel: 0.01}}}"}) {
    const std::string text = std::string(kSmoother) + other + "\n";
    EXPECT_EQ(refusal_of(text), "") << other;
    const ControllerFile file = read_controller_settings(directory.write("p.yaml", text));
    EXPECT_EQ(file.speed_m_s, 0.5) << other;
    EXPECT_EQ(file.yaw_rate_rad_s, 2.0) << other;
  }
}

/// One limit in each way in which a file may write it.
TEST(ControllerFile, EveryFormThatItsProgramReadsIsTheSameLimit) {
  const ScratchDirectory directory;
  const auto plugin = [](const std::string& type, const std::string& keys) {
    return "controller_server: {ros__parameters: {FollowPath: {plugin: " + type + ", " + keys + "}}}\n";
  };
  const auto axes = [](const std::string& keys) {
    return "diff_drive_controller: {ros__parameters: {" + keys + "}}\n";
  };
  for (const std::string& text :
       {plugin("nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController",
               "max_linear_vel: 0.3, max_angular_vel: 1.1, max_linear_decel: -0.4"),
        plugin("nav2_mppi_controller::MPPIController", "vx_max: 0.3, wz_max: 1.1, ax_min: -0.4"),
        plugin("dwb_core::DWBLocalPlanner", "max_vel_x: 0.3, max_vel_theta: 1.1, decel_lim_x: -0.4"),
        plugin("nav2_graceful_controller::GracefulController",
               "v_linear_max: 0.3, v_angular_max: 1.1, deceleration_max: 0.4"),
        std::string("controller_server: {ros__parameters: {FollowPath.vx_max: 0.3, FollowPath.wz_max: 1.1, "
                    "FollowPath.ax_min: -0.4}}\n"),
        std::string("velocity_smoother: {ros__parameters: {max_velocity: [0.3, 0, 1.1], "
                    "max_decel: [-0.4, 0, 0]}}\n"),
        std::string("velocity_smoother: {ros__parameters: {max_velocity: [0.3, 0, 0, 0, 0, 1.1], "
                    "max_decel: [-0.4, 0, 0, 0, 0, 0]}}\n"),
        axes("linear: {x: {max_velocity: 0.3, min_acceleration: -0.4, max_acceleration: .nan}}, "
             "angular: {z: {max_velocity: 1.1}}"),
        axes("linear: {x: {max_velocity: 0.3, max_deceleration: -0.4}}, angular: {z: {max_velocity: 1.1, "
             "has_acceleration_limits: false, max_acceleration: 0.1}}"),
        axes("linear.x.max_velocity: 0.3, linear.x.min_acceleration: -0.4, angular.z.max_velocity: 1.1, "
             "linear.x.has_velocity_limits: true")}) {
    const ControllerFile file = read_controller_settings(directory.write("p.yaml", text));
    EXPECT_EQ(file.speed_m_s, 0.3) << text;
    EXPECT_EQ(file.yaw_rate_rad_s, 1.1) << text;
    EXPECT_EQ(file.deceleration_m_s2, 0.4) << text;
    EXPECT_EQ(file.acceleration_m_s2, std::nullopt) << text;
    EXPECT_EQ(file.yaw_acceleration_rad_s2, std::nullopt) << text;
    EXPECT_EQ(file.lines, std::vector<int>(file.read.size(), 1));
  }
}

TEST(ControllerFile, WhatAKnownControllerDoesBesideIsSaid) {
  const ScratchDirectory directory;
  const ControllerFile file = read_controller_settings(directory.write(
      "p.yaml",
      "controller_server:\n  ros__parameters:\n    FollowPath:\n      plugin: a::GracefulController\n"
      "      v_linear_max: 0.3\n      cruise_speed: 0.2\n"));
  EXPECT_EQ(file.lines, std::vector<int>{5});
  ASSERT_EQ(file.unused.size(), 1u);
  EXPECT_NE(file.unused[0].find("cruise_speed in line 6"), std::string::npos) << file.unused[0];
  ASSERT_EQ(file.not_modelled.size(), 1u);
  EXPECT_NE(file.not_modelled[0].find("FollowPath: slower in curves"), std::string::npos);
}

TEST(ControllerFile, OneOfSeveralIsChosenByName) {
  const ScratchDirectory directory;
  const std::string file = directory.write(
      "p.yaml",
      kSmoother +
          std::string("controller_server: {ros__parameters: {controller_plugins: [FollowPath, Docking], "
                      "FollowPath: {plugin: a::B, vx_max: 0.4}, Docking: {plugin: a::B, vx_max: "
                      "0.05}}}\n"));
  EXPECT_EQ(read_controller_settings(file, "FollowPath").speed_m_s, 0.4);
  EXPECT_EQ(read_controller_settings(file, "Docking").speed_m_s, 0.05);
  EXPECT_EQ(read_controller_settings(file, "Docking").acceleration_m_s2, 0.5) << "the smoother's holds, too";
  EXPECT_THROW((void)read_controller_settings(file, "Dock"), ConfigError);
}

TEST(ControllerFile, ParametersOfRos1AreCalledSo) {
  EXPECT_NE(refusal_of("TebLocalPlannerROS: {max_vel_x: 0.4, acc_lim_x: 0.5}\n").find("ROS 1"),
            std::string::npos);
}

TEST(ControllerFile, AFileWithoutSpeedsIsRefused) {
  const ScratchDirectory directory;
  EXPECT_THROW((void)read_controller_settings(directory.write("p.yaml", "amcl: {alpha1: 0.2}\n")),
               ConfigError);
}

}  // namespace
}  // namespace joulepath
