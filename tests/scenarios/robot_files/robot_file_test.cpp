#include "scenarios/robot_files/robot_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "scenarios/robot_files/implausible_constants.hpp"
#include "scenarios/robot_files/robot_check.hpp"
#include "tests/scenarios/scratch_directory.hpp"
#include "tests/support/locations.hpp"
#include "tests/support/nomad.hpp"

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
      {"center_of_mass_offset_m", [](Robot& r) { r.geometry.center_of_mass_offset_m -= 5; }},
      {"chassis_mass_kg", [](Robot& r) { r.inertia.chassis_mass_kg *= 1000; }},
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
                        {"of one cell", [](Motor& m) { m.max_voltage_V = 4.6; }},
                        {"torque_constant_Nm_A in mN m/A", [](Motor& m) {
                           m.torque_constant_Nm_A *= 1000, m.voltage_constant_V_s_rad *= 1000;
                         }}};
  const Robot robot = read_robot(kNomad);
  for (const Slip& slip : slips) {
    Robot wrong = robot;
    for (const Side side : kSides) slip.make(wrong.motor[side]);
    const std::vector<std::string> notes = implausible_constants(wrong);
    ASSERT_GE(notes.size(), 1u) << slip.told;
    EXPECT_NE(notes[0].find(slip.told), std::string::npos) << notes[0];
  }
}

TEST(RobotFile, ASpeedLimitInKilometersPerHourIsAskedFor) {
  Robot robot = read_robot(kNomad);
  robot.limits->speed_m_s *= 3.6;
  ASSERT_FALSE(implausible_constants(robot).empty());
  EXPECT_NE(implausible_constants(robot)[0].find("is the limit in km/h"), std::string::npos);
}

TEST(RobotFile, TextReadsBackAsTheSameRobot) {
  Robot robot = read_robot(kNomad);
  robot.geometry.wheel_radius_m = {0.1 / 3.0, 0.1};
  robot.payload_offset_m = -0.1 / 7.0;
  robot.footprint = {.polygon_m = {{0.1, 0.2}, {-0.1, 0.2}, {0.0, -0.3}}};
  robot.power.sharing = PowerSharing::bus;
  robot.effects = {{.name = "rolling_resistance", .parameters = {{"coefficient", 0.0151}}},
                   {.name = "dragging_wheel", .parameters = {{"torque_Nm", 0.07}}, .side = Side::right},
                   {.name = "floor_patch",
                    .parameters = {{"coefficient", 0.02}},
                    .cells = {{0, 1, 2, 3}},
                    .probability = 0.7}};
  robot.uncertainty_correlations = {{"friction_torque_Nm", "viscous_friction_Nm_s_rad", -0.87},
                                    {"resistance_ohm", "torque_constant_Nm_A", 1.0 / 3}};
  const std::string text = robot_text(robot);
  const Robot again = robot_from(Document::parse(text, "again.yaml"));
  EXPECT_EQ(robot_text(again), text);
  EXPECT_EQ(again.geometry.wheel_radius_m, robot.geometry.wheel_radius_m);
  EXPECT_EQ(again.payload_offset_m, robot.payload_offset_m);
  EXPECT_EQ(again.effects[1].side, Side::right);
  EXPECT_EQ(again.effects[2].cells, robot.effects[2].cells);
  EXPECT_EQ(again.effects[2].probability, 0.7);
  EXPECT_EQ(again.effects[1].probability, 1.0);
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

/// A corrected robot's file is its own file: only the lines of what changed differ, with six digits.
TEST(RobotFile, ACorrectionKeepsTheFilesComments) {
  const std::string file = JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml";
  const auto lines_of = [](const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
  };
  std::ifstream stream(file);
  const std::string own{std::istreambuf_iterator<char>(stream), {}};
  Robot robot = read_robot(file);
  EXPECT_EQ(robot_text_like(file, robot), own) << "nothing changed";
  robot.motor.left.friction_torque_Nm *= 1.123456789;
  robot.motor.left.resistance_ohm = robot.motor.right.resistance_ohm = 2.987654321;
  const std::string text = robot_text_like(file, robot);
  const auto before = lines_of(own), after = lines_of(text);
  ASSERT_EQ(before.size(), after.size()) << text;
  std::size_t differ = 0;
  for (std::size_t k = 0; k < before.size(); ++k) differ += before[k] != after[k];
  EXPECT_LE(differ, 2u) << text;
  EXPECT_NE(text.find("2.98765"), std::string::npos) << text;
  EXPECT_EQ(text.find("2.987654"), std::string::npos) << text;
  EXPECT_EQ(std::count(text.begin(), text.end(), '#'), std::count(own.begin(), own.end(), '#'));
  const Robot again = robot_from(Document::parse(text, file));
  EXPECT_NEAR(again.motor.left.friction_torque_Nm, robot.motor.left.friction_torque_Nm, 1e-6);
  EXPECT_EQ(again.motor.right.friction_torque_Nm, robot.motor.right.friction_torque_Nm);
}

/// A file that cannot be edited in place is written anew.
TEST(RobotFile, ACorrectionOfANotationThatCannotBeEditedIsWhole) {
  const ScratchDirectory scratch;
  std::string text = robot_text(testing::nomad());
  const std::string aliased = "name: &n nomad\n";
  text.replace(text.find("name:"), text.find('\n', text.find("name:")) + 1 - text.find("name:"), aliased);
  const std::string file = scratch.write("robot.yaml", text);
  Robot robot = testing::nomad();
  robot.power.standby_W = 12.5;
  EXPECT_EQ(robot_from(Document::parse(robot_text_like(file, robot), file)).power.standby_W, 12.5);
  EXPECT_EQ(robot_text_like("", robot), robot_text(robot));
}

}  // namespace
}  // namespace joulepath
