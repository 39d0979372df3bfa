// A patched model is the model of the robot with the effects, and nothing else of the file changes.
#include "extensions/simulators/simulator_patch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include "extensions/simulators/mechanism_draft.hpp"
#include "extensions/simulators/model_export.hpp"
#include "extensions/simulators/model_files.hpp"
#include "extensions/simulators/xml_edits.hpp"
#include "tests/scenarios/scratch_directory.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// The values of a model that effects change, by the reader alone.
struct PatchedValues {
  Sided<double> friction_Nm{}, damping_Nm_s_rad{}, radius_m{};
  double yaw_kg_m2{}, center_m{}, mass_kg{};
};

PatchedValues values_of(const std::string& file) {
  const Mechanism mechanism = read_mechanism(XmlFile(file).root());
  const DriveParts parts = drive_parts_of(mechanism, {});
  return {{parts.joint.left->friction_Nm, parts.joint.right->friction_Nm},
          {parts.joint.left->damping_Nm_s_rad, parts.joint.right->damping_Nm_s_rad},
          parts.radius_m,
          parts.chassis_yaw_inertia_kg_m2,
          parts.center_of_mass_offset_m,
          parts.mass_kg};
}

Robot patch_robot() {
  Robot robot = testing::nomad();
  for (const Side side : kSides) {
    robot.motor[side].friction_torque_Nm = 0.21;
    robot.motor[side].viscous_friction_Nm_s_rad = 0.013;
  }
  return robot;
}

EffectSetting effect_of(const std::string& name, const std::string& parameter, double value,
                        std::optional<Side> side = {}) {
  return {.name = name, .parameters = {{parameter, value}}, .side = side};
}

TEST(SimulatorPatch, EachFormatReadsBackWithTheEffects) {
  const ScratchDirectory scratch;
  const Robot robot = patch_robot();
  const std::vector<EffectSetting> effects{effect_of("coulomb_friction", "torque_Nm", -0.05),
                                           effect_of("viscous_friction", "coefficient_Nm_s_rad", 0.004),
                                           effect_of("dragging_wheel", "torque_Nm", 0.11, Side::right),
                                           effect_of("rolling_resistance", "coefficient", 0.01),
                                           effect_of("wheel_radius_mismatch", "fraction", 0.02),
                                           effect_of("yaw_inertia_error", "fraction", 0.3),
                                           effect_of("center_of_mass_offset", "offset_m", -0.03)};
  for (const std::string format : {"mjcf", "sdf", "urdf"}) {
    const std::string file = scratch.write("robot." + format, model_export(robot, 0.0, format).text);
    const PatchedValues before = values_of(file);
    const SimulatorPatch patch = simulator_patch(file, effects, {});
    EXPECT_EQ(patch.changes.size(), effects.size()) << format;
    EXPECT_TRUE(patch.not_in_model.empty()) << format << " " << patch.not_in_model.front().effect;
    const PatchedValues after = values_of(scratch.write("patched." + format, patch.text));
    const double load_Nm = 0.01 * 0.5 * before.mass_kg * 9.80665 * before.radius_m.left;
    EXPECT_NEAR(after.friction_Nm.left, before.friction_Nm.left - 0.05 + load_Nm, 1e-6) << format;
    EXPECT_NEAR(after.friction_Nm.right, before.friction_Nm.right + 0.06 + load_Nm, 1e-6) << format;
    EXPECT_NEAR(after.damping_Nm_s_rad.left, 0.017, 1e-9) << format;
    EXPECT_NEAR(after.damping_Nm_s_rad.right, 0.017, 1e-9) << format;
    EXPECT_NEAR(after.radius_m.left, 1.01 * before.radius_m.left, 1e-9) << format;
    EXPECT_NEAR(after.radius_m.right, 0.99 * before.radius_m.right, 1e-9) << format;
    EXPECT_NEAR(after.yaw_kg_m2, 1.3 * before.yaw_kg_m2, 1e-6) << format;
    EXPECT_NEAR(after.center_m, before.center_m - 0.03, 1e-9) << format;
    EXPECT_NEAR(after.mass_kg, before.mass_kg, 1e-12) << format;
  }
}

/// Torque = (K / R) (voltage - Kv speed) with the true constants.
TEST(SimulatorPatch, MotorConstantsChangeTheActuators) {
  const ScratchDirectory scratch;
  Robot robot = patch_robot();
  const std::string file = scratch.write("robot.xml", model_export(robot, 0.0, "mjcf").text);
  const SimulatorPatch patch = simulator_patch(file,
                                               {effect_of("torque_constant_error", "fraction", 0.1),
                                                effect_of("winding_resistance_error", "fraction", -0.2)},
                                               {});
  EXPECT_EQ(patch.changes.size(), 2U);
  for (const Side side : kSides) {
    robot.motor[side].torque_constant_Nm_A *= 1.1;
    robot.motor[side].voltage_constant_V_s_rad *= 1.1;
    robot.motor[side].resistance_ohm *= 0.8;
  }
  const XmlFile expected(file, model_export(robot, 0.0, "mjcf").text), patched(file, patch.text);
  const auto actuators = [](const XmlFile& xml) { return xml.root().descendants("general"); };
  ASSERT_EQ(actuators(patched).size(), 2U);
  for (std::size_t i = 0; i < 2; ++i)
    for (const char* name : {"gainprm", "biasprm"}) {
      const XmlElement is = actuators(patched)[i], should = actuators(expected)[i];
      const auto a = is.numbers(is.required(name), 0), b = should.numbers(should.required(name), 0);
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], 1e-6 * std::abs(b[k])) << name;
    }
}

TEST(SimulatorPatch, WhatAFileCannotSayIsToldAndLeavesItAsItIs) {
  const ScratchDirectory scratch;
  const std::string text = model_export(patch_robot(), 0.0, "urdf").text;
  const std::string file = scratch.write("robot.urdf", text);
  const SimulatorPatch patch = simulator_patch(
      file,
      {effect_of("turning_scrub", "moment_Nm", 0.6), effect_of("torque_constant_error", "fraction", 0.1),
       effect_of("current_sensor_gain", "fraction", 0.02), effect_of("coulomb_friction", "torque_Nm", -0.5)},
      {});
  EXPECT_EQ(patch.text, text);
  EXPECT_TRUE(patch.diff.empty());
  EXPECT_TRUE(patch.changes.empty());
  ASSERT_EQ(patch.not_in_model.size(), 4U) << "a friction below zero is none that a file may state";
  EXPECT_NE(patch.not_in_model[0].what.find("yaw moment"), std::string::npos);
  EXPECT_NE(patch.not_in_model[2].what.find("log"), std::string::npos);
}

/// A file as people write it: comments, both quotes, carriage returns, a joint without dynamics.
TEST(SimulatorPatch, LinesWithoutAChangeStayByteForByte) {
  const ScratchDirectory scratch;
  std::string text = model_export(patch_robot(), 0.0, "sdf").text;
  const auto erase = [&](const std::string& begin, const std::string& end) {
    const auto at = text.find(begin);
    ASSERT_NE(at, std::string::npos);
    text.erase(at, text.find(end, at) + end.size() - at);
  };
  erase("<dynamics>", "</dynamics>");  // of the left wheel
  const auto root = text.find("<sdf");
  text.insert(root, "<!-- <joint name='left_wheel_joint'> a > b -->\r\n");
  const std::string file = scratch.write("robot.sdf", text);
  const SimulatorPatch patch = simulator_patch(file, {effect_of("coulomb_friction", "torque_Nm", 0.02)}, {});
  ASSERT_EQ(patch.changes.size(), 1U);
  const PatchedValues after = values_of(scratch.write("patched.sdf", patch.text));
  EXPECT_NEAR(after.friction_Nm.left, 0.02, 1e-12);
  EXPECT_NEAR(after.friction_Nm.right, 0.23, 1e-12);
  std::size_t same = 0;
  std::istringstream a(text), b(patch.text);
  for (std::string before, now; std::getline(a, before) && std::getline(b, now);) same += before == now;
  EXPECT_EQ(same, static_cast<std::size_t>(std::ranges::count(text, '\n')) - 2) << "two joints differ";
  // The difference is one that `patch` applies.
  scratch.write("p.diff", patch.diff);
  const std::string by_patch = scratch.at("by_patch.sdf");
  ASSERT_EQ(
      std::system(
          ("patch --binary -s -o '" + by_patch + "' '" + file + "' '" + scratch.at("p.diff") + "'").c_str()),
      0);
  std::ifstream stream(by_patch, std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), patch.text);
}

TEST(XmlEdits, TagsAreFoundAsTheParserCountsThem) {
  XmlEdits edits(
      "<?xml version='1.0'?>\n<!DOCTYPE a>\n<a b='x > y'><!-- <c/> --><![CDATA[<d>]]><e/><f  g = \"1\" "
      "/></a>\n");
  edits.set_attribute(0, "b", "z");
  edits.set_attribute(1, "n", "2");
  edits.set_attribute(2, "g", "3");
  EXPECT_EQ(edits.text(),
            "<?xml version='1.0'?>\n<!DOCTYPE a>\n<a b='z'><!-- <c/> --><![CDATA[<d>]]><e n=\"2\"/><f  g = "
            "\"3\" /></a>\n");
}

TEST(XmlEdits, TextsStandBesideComments) {
  XmlEdits edits("<a><b><!-- was <c>0.1</c> -->0.2</b><b>0.3 <!-- CAD --></b></a>");
  edits.set_text(1, "5");
  edits.set_text(2, "6");
  EXPECT_EQ(edits.text(), "<a><b><!-- was <c>0.1</c> -->5</b><b>6 <!-- CAD --></b></a>");
}

TEST(XmlEdits, TextsAndChildrenAreAddedToEmptyElements) {
  XmlEdits edits("<a><b/><c> 1 </c><d></d></a>");
  edits.insert_child(1, "<x/>");
  edits.set_text(2, "2");
  edits.set_text(3, "3");
  EXPECT_EQ(edits.text(), "<a><b><x/></b><c> 2 </c><d>3</d></a>");
}

}  // namespace
}  // namespace joulepath
