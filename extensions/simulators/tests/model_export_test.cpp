// What is written reads back: a robot as a model of another simulator and a plant model as a graph.
#include "extensions/simulators/model_export.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "extensions/simulators/plant_model.hpp"
#include "model/dynamics.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "scenarios/robot_files/robot_sources.hpp"
#include "tests/scenarios/scratch_directory.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

TEST(ModelExport, EachFormatReadsBackAsTheRobot) {
  const ScratchDirectory scratch;
  Robot robot = testing::nomad();
  robot.name = "a & <b>";
  robot.geometry.center_of_mass_offset_m = 0.04;
  for (const Side side : kSides) {
    robot.motor[side].viscous_friction_Nm_s_rad = 0.013;
    robot.motor[side].friction_torque_Nm = 0.21;
  }
  for (const std::string format : {"mjcf", "sdf", "urdf"}) {
    const ModelExport model = model_export(robot, 0.0, format);
    const RobotDraft draft = draft_from({scratch.write("robot." + format, model.text)}, {});
    std::map<std::string, std::string> values;
    for (const DraftValue& value : draft.values) values[value.key] = value.text;
    EXPECT_EQ(draft.name, robot.name) << format;
    const auto expect = [&](const char* key, double value) {
      ASSERT_TRUE(values.contains(key)) << format << " " << key;
      EXPECT_NEAR(std::stod(values[key]), value, 1e-5 * std::abs(value)) << format << " " << key;
    };
    expect("geometry.wheel_radius_m", robot.geometry.wheel_radius_m.left);
    expect("geometry.half_track_m", robot.geometry.half_track_m);
    expect("geometry.center_of_mass_offset_m", 0.04);
    expect("inertia.chassis_mass_kg", robot.inertia.chassis_mass_kg);
    expect("inertia.chassis_yaw_inertia_kg_m2", robot.inertia.chassis_yaw_inertia_kg_m2);
    expect("inertia.wheel_diameter_inertia_kg_m2", robot.inertia.wheel_diameter_inertia_kg_m2);
    expect("motor.viscous_friction_Nm_s_rad", 0.013);
    expect("motor.friction_torque_Nm", 0.21);
    if (format == "mjcf")
      expect("inertia.wheel_axle_inertia_kg_m2", robot.inertia.wheel_axle_inertia_kg_m2);
    else
      EXPECT_FALSE(model.lost.empty());
  }
}

/// Torque = (K / R) (voltage - Kv speed).
TEST(ModelExport, ActuatorsOfMjcfAreTheMotors) {
  const Robot robot = testing::nomad();
  const Motor& motor = robot.motor.left;
  const std::string text = model_export(robot, 0.0, "mjcf").text;
  const auto number_after = [&](const std::string& mark) {
    const auto at = text.find(mark);
    EXPECT_NE(at, std::string::npos) << mark;
    return at == std::string::npos ? 0.0 : std::stod(text.substr(at + mark.size()));
  };
  const double gain_Nm_V = motor.torque_per_ampere_Nm_A() / motor.resistance_ohm;
  EXPECT_NEAR(number_after("gainprm=\""), gain_Nm_V, 1e-6 * gain_Nm_V);
  const double bias = -gain_Nm_V * motor.volts_per_speed_V_s_rad();
  EXPECT_NEAR(number_after("biasprm=\"0 0 "), bias, 1e-6 * std::abs(bias));
}

TEST(ModelExport, APayloadIsAPartOfTheChassis) {
  const ScratchDirectory scratch;
  const Robot robot = testing::nomad();
  const RobotDraft draft =
      draft_from({scratch.write("robot.urdf", model_export(robot, 8.0, "urdf").text)}, {});
  const auto mass = std::ranges::find(draft.values, std::string("inertia.chassis_mass_kg"), &DraftValue::key);
  ASSERT_NE(mass, draft.values.end());
  EXPECT_NEAR(std::stod(mass->text), robot.inertia.chassis_mass_kg + 8.0, 1e-9);
}

TEST(PlantModel, PointsAndPathsAreInMillimeters) {
  const ScratchDirectory scratch;
  const std::string file =
      scratch.write("plant.xml", R"(<?xml version="1.0"?><model version="6.0.0" name="hall">
  <point name="A" positionX="-2000" positionY="500"/><point name="B" xPosition="1000" yPosition="4500"/>
  <path name="A-B" sourcePoint="A" destinationPoint="B" length="5000" maxVelocity="800" maxReverseVelocity="300"/>
  <path name="B-A" sourcePoint="B" destinationPoint="A" maxVelocity="800" locked="true"/></model>)");
  ASSERT_TRUE(is_plant_model(file));
  const ForeignGraph graph = read_plant_model(file);
  ASSERT_EQ(graph.nodes.size(), 2u);
  EXPECT_NEAR(graph.nodes[0].x_m, -2, 1e-12);
  EXPECT_NEAR(graph.nodes[1].y_m, 4.5, 1e-12);
  ASSERT_EQ(graph.edges.size(), 1u);
  EXPECT_NEAR(*graph.edges[0].speed_limit_m_s, 0.8, 1e-12);
  EXPECT_EQ(graph.notes.size(), 3u);
}

}  // namespace
}  // namespace joulepath
