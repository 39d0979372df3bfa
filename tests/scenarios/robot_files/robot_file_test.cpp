#include "scenarios/robot_files/robot_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "scenarios/robot_files/implausible_constants.hpp"
#include "scenarios/robot_files/robot_check.hpp"
#include "tests/scenarios/scratch_directory.hpp"
#include "tests/support/locations.hpp"

namespace joulepath {
namespace {

const std::string kNomad = JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml";

TEST(RobotFile, NomadHoldsThePapersTables) {
  const Robot robot = read_robot(kNomad);
  EXPECT_EQ(robot.name, "nomad_super_scout");
  EXPECT_EQ(robot.geometry.wheel_radius_m, (Sided<double>{0.1, 0.1}));
  EXPECT_EQ(robot.geometry.half_track_m, 0.165);
  EXPECT_EQ(robot.motor.left.friction_torque_Nm, 0.3728);
  EXPECT_EQ(robot.motor.right.friction_torque_Nm, 0.346);
  EXPECT_NEAR(robot.total_mass_kg(0.0), 21.2 + 2 * 1.39, 1e-12);
  ASSERT_TRUE(robot.limits);
  EXPECT_EQ(robot.limits->max_payload_kg, 12.0);
  EXPECT_EQ(robot.limits->jerk_m_s3, kNoLimit);
  ASSERT_EQ(robot.limits_by_payload.size(), 2u);
  EXPECT_EQ(robot.limits_by_payload[1].limit_by_key.at("acceleration_m_s2"), 0.3);
  EXPECT_EQ(robot.uncertainty.at("friction_torque_Nm"), 0.015);
}

TEST(RobotFile, OddButPossibleFiguresAreNoted) {
  Robot robot = read_robot(kNomad);
  EXPECT_TRUE(robot_notes(robot).empty());
  robot.footprint = {.polygon_m = {{0.3, 0.15}, {-0.3, 0.15}, {-0.3, -0.15}, {0.3, -0.15}}};
  ASSERT_EQ(robot_notes(robot).size(), 1u);
  EXPECT_NE(robot_notes(robot).front().find("outside of the footprint"), std::string::npos);
  robot.motor.left.torque_constant_Nm_A = 0.85 * robot.motor.left.voltage_constant_V_s_rad;
  EXPECT_EQ(robot_notes(robot).size(), 2u);
}

/// A slip of a unit in one constant is noted with its key; no shipped robot has a note of the kind.
TEST(RobotFile, ConstantsThatMassAndSizeContradictAreNoted) {
  struct Slip {
    const char* key;
    void (*make)(Robot&);
  };
  const Slip slips[] = {
      {"chassis_yaw_inertia_kg_m2", [](Robot& r) { r.inertia.chassis_yaw_inertia_kg_m2 *= 1e4; }},
      {"chassis_yaw_inertia_kg_m2", [](Robot& r) { r.inertia.chassis_yaw_inertia_kg_m2 *= 1e-3; }},
      {"yaw_rate_rad_s", [](Robot& r) { r.limits->yaw_rate_rad_s *= 57.3; }},
      {"yaw_acceleration_rad_s2", [](Robot& r) { r.limits->yaw_acceleration_rad_s2 *= 57.3; }},
      {"capacity_Wh", [](Robot& r) { r.battery.capacity_Wh *= 1000; }},
      {"capacity_Wh", [](Robot& r) { r.battery.capacity_Wh /= 25; }},
      {"standby_W", [](Robot& r) { r.power.standby_W *= 1000; }}};
  for (const auto& entry : std::filesystem::directory_iterator(JOULEPATH_SOURCE_DIR "/scenarios/robots")) {
    if (entry.path().extension() != ".yaml") continue;
    const Robot robot = read_robot(entry.path());
    EXPECT_TRUE(implausible_constants(robot).empty()) << entry.path() << implausible_constants(robot).front();
    for (const Slip& slip : slips) {
      Robot wrong = robot;
      if (!wrong.limits && std::string(slip.key).starts_with("yaw_")) continue;
      if (!std::isfinite(wrong.battery.capacity_Wh) && std::string(slip.key) == "capacity_Wh") continue;
      slip.make(wrong);
      const std::vector<std::string> notes = implausible_constants(wrong);
      ASSERT_EQ(notes.size(), 1u) << entry.path() << slip.key;
      EXPECT_NE(notes[0].find(slip.key), std::string::npos) << notes[0];
    }
  }
}

TEST(RobotFile, ABatteryThatDoesNotFitTheMotorsIsNoted) {
  const Robot robot = read_robot(kNomad);
  Robot of_one_cell = robot, ten_times = robot;
  of_one_cell.battery.open_circuit_voltage_V = 4.6;
  for (const Side side : kSides) ten_times.motor[side].max_voltage_V *= 10;
  for (const Robot& wrong : {of_one_cell, ten_times})
    EXPECT_TRUE(std::ranges::any_of(implausible_constants(wrong), [](const std::string& note) {
      return note.starts_with("motor.max_voltage_V ") &&
             note.find("battery.open_circuit_voltage_V") != std::string::npos;
    }));
}

TEST(RobotFile, FrictionAtTheShaftAndAFootprintInCentimetersAreNoted) {
  Robot at_shaft = read_robot(kNomad), in_cm = at_shaft;
  for (const Side side : kSides) at_shaft.motor[side].friction_torque_Nm /= at_shaft.motor[side].gear_ratio;
  ASSERT_FALSE(implausible_constants(at_shaft).empty());
  EXPECT_NE(implausible_constants(at_shaft)[0].find("motor's shaft"), std::string::npos);
  at_shaft.effects = {{.name = "rolling_resistance", .parameters = {{"coefficient", 0.01}}}};
  EXPECT_TRUE(implausible_constants(at_shaft).empty()) << "the wheels' resistance is stated apart";
  in_cm.footprint.radius_m *= 100;
  EXPECT_NE(implausible_constants(in_cm).back().find("is it in cm?"), std::string::npos);
}

/// A slip in the motor's constants leaves a robot that cannot move, or one much faster or slower than its
/// limit.
TEST(RobotFile, MotorsThatDoNotFitTheRobotAreNoted) {
  struct Slip {
    const char* told;
    void (*make)(Motor&);
  };
  const Slip slips[] = {{"cannot move", [](Motor& m) { m.gear_ratio = 1 / m.gear_ratio; }},
                        {"cannot move", [](Motor& m) { m.resistance_ohm *= 1000; }},
                        {"motor.resistance_ohm", [](Motor& m) { m.resistance_ohm /= 1000; }},
                        {"ten times too high", [](Motor& m) { m.max_voltage_V *= 10; }},
                        {"of one cell", [](Motor& m) { m.max_voltage_V = 4.6; }}};
  const Robot robot = read_robot(kNomad);
  for (const Slip& slip : slips) {
    Robot wrong = robot;
    for (const Side side : kSides) slip.make(wrong.motor[side]);
    const std::vector<std::string> notes = implausible_constants(wrong);
    ASSERT_GE(notes.size(), 1u) << slip.told;
    EXPECT_NE(notes[0].find(slip.told), std::string::npos) << notes[0];
  }
}

TEST(RobotFile, TextReadsBackAsTheSameRobot) {
  Robot robot = read_robot(kNomad);
  robot.geometry.wheel_radius_m = {0.1 / 3.0, 0.1};
  robot.payload_offset_m = -0.1 / 7.0;
  robot.footprint = {.polygon_m = {{0.1, 0.2}, {-0.1, 0.2}, {0.0, -0.3}}};
  robot.power.sharing = PowerSharing::bus;
  robot.effects = {{.name = "rolling_resistance", .parameters = {{"coefficient", 0.0151}}},
                   {.name = "dragging_wheel", .parameters = {{"torque_Nm", 0.07}}, .side = Side::right},
                   {.name = "floor_patch", .parameters = {{"coefficient", 0.02}}, .cells = {{0, 1, 2, 3}}}};
  robot.uncertainty_correlations = {{"friction_torque_Nm", "viscous_friction_Nm_s_rad", -0.87},
                                    {"resistance_ohm", "torque_constant_Nm_A", 1.0 / 3}};
  const std::string text = robot_text(robot);
  const Robot again = robot_from(Document::parse(text, "again.yaml"));
  EXPECT_EQ(robot_text(again), text);
  EXPECT_EQ(again.geometry.wheel_radius_m, robot.geometry.wheel_radius_m);
  EXPECT_EQ(again.payload_offset_m, robot.payload_offset_m);
  EXPECT_EQ(again.effects[1].side, Side::right);
  EXPECT_EQ(again.effects[2].cells, robot.effects[2].cells);
  EXPECT_EQ(again.footprint.polygon_m, robot.footprint.polygon_m);
  EXPECT_EQ(again.limits_by_payload[1].limit_by_key, robot.limits_by_payload[1].limit_by_key);
  EXPECT_EQ(again.uncertainty, robot.uncertainty);
  EXPECT_EQ(again.uncertainty_correlations, robot.uncertainty_correlations);
}

TEST(RobotFile, LimitsAndBatteryAreNotNeededForDiagnosis) {
  const Robot robot = robot_from(Document::parse(R"(
geometry: {wheel_radius_m: {left: 0.1, right: 0.101}, half_track_m: 0.165}
inertia: {chassis_mass_kg: 21.2, wheel_mass_kg: 1.39, chassis_yaw_inertia_kg_m2: 0.5, payload_yaw_inertia_m2: 0.02,
          wheel_axle_inertia_kg_m2: 0.0281, wheel_diameter_inertia_kg_m2: 0.007}
motor: {gear_ratio: 24.9, resistance_ohm: 2.74, torque_constant_Nm_A: 0.069, voltage_constant_V_s_rad: 0.069,
        viscous_friction_Nm_s_rad: 0.0017, friction_torque_Nm: 0.3}
)",
                                                 "folder/bot.yaml"));
  EXPECT_FALSE(robot.limits);
  EXPECT_EQ(robot.name, "bot");
  EXPECT_EQ(robot.geometry.wheel_radius_m.right, 0.101);
  EXPECT_EQ(robot.motor.left.max_voltage_V, kNoLimit);
  EXPECT_EQ(robot.battery.capacity_Wh, kNoLimit);
}

TEST(RobotFile, AnErrorNamesFileLineColumnKeyFoundAcceptedAndTheNearestKey) {
  try {
    static_cast<void>(robot_from(Document::parse(
        "schema: joulepath/robot/1\ngeometry:\n  wheel_radus_m: 0.1\n  half_track_m: 1\n", "r.yaml")));
    FAIL() << "no error";
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.detail().mark.file, "r.yaml");
    // Several required values are missing: all are listed before the values inside of a section are checked.
    for (const char* key : {"geometry.wheel_radius_m", "inertia.chassis_mass_kg", "motor.friction_torque_Nm"})
      EXPECT_NE(error.detail().found.find(key), std::string::npos) << key;
  }
  try {
    static_cast<void>(robot_from(Document::parse(
        "geometry:\n  wheel_radus_m: 0.1\n  half_track_m: 1\ninertia: {}\nmotor: {}\n", "r.yaml")));
    FAIL() << "no error";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(
        error.what(),
        "r.yaml:2:3: geometry.wheel_radus_m: found an unknown key, accepted: wheel_radius_m, half_track_m, "
        "center_of_mass_offset_m (did you mean wheel_radius_m?)");
  }
}

}  // namespace
}  // namespace joulepath
