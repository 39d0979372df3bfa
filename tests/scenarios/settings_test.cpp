#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "planner/mission/mission.hpp"
#include "scenarios/controller_settings.hpp"
#include "scenarios/export/exports.hpp"
#include "scenarios/mission_file.hpp"
#include "tests/scenarios/scratch_directory.hpp"

namespace joulepath {
namespace {

struct PlannedRound {
  MissionRequest mission{};
  MissionWorld world{};
  Plan plan{};
  Plant plant{};

  explicit PlannedRound(const std::string& robot) {
    LegRequest there{.path = PathRequest{.bezier_m = {{{{0, 0}, {2, 0}, {4, 0}, {6, 0}}}}},
                     .payload = {5, 5}};
    LegRequest curve{.path = PathRequest{.bezier_m = {{{{0, 0}, {2.7, 0}, {2.7, 0}, {2.7, 2.7}}}}},
                     .payload = {5, 5}};
    mission = {.name = "round", .legs = {there, curve}};
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

TEST(HeavyRobot, SettingsAreNotLate) {
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
  }
}

TEST(Nav2Settings, ReadBackAsWhatTheyWereWrittenFrom) {
  const ScratchDirectory directory;
  const Export written = export_nav2_settings(heavy().input("settings.yaml"));
  EXPECT_EQ(written.files.at(0).content.find(" -0 J"), std::string::npos);
  const ControllerFile file =
      read_controller_settings(directory.write("settings.yaml", written.files.at(0).content));
  ASSERT_TRUE(file.speed_m_s && file.acceleration_m_s2 && file.deceleration_m_s2);
  const ControlledDrive drive = drive_with(heavy().plan, file);
  EXPECT_NEAR(drive.duration_s, written.loss->own_time.duration_s, 2e-3 * drive.duration_s);
  EXPECT_NEAR(drive.energy_J, written.loss->own_time.energy_J, 5e-3 * drive.energy_J);
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

TEST(ControllerFile, AFileWithoutSpeedsIsRefused) {
  const ScratchDirectory directory;
  EXPECT_THROW((void)read_controller_settings(directory.write("p.yaml", "amcl: {alpha1: 0.2}\n")),
               ConfigError);
}

}  // namespace
}  // namespace joulepath
