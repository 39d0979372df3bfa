// One robot of our own, written as URDF, SDF and MJCF, against its values by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "scenarios/any_file.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "scenarios/robot_files/robot_sources.hpp"
#include "tests/scenarios/scratch_directory.hpp"

namespace joulepath {
namespace {

/// A box of 10 kg 5 cm before the axle, a battery of 2 kg 10 cm behind it, two wheels of 0.5 kg, a caster.
const std::string kUrdf = R"(<?xml version="1.0"?>
<robot name="cart">
  <link name="base">
    <inertial><origin xyz="0.05 0 0.1"/><mass value="10"/>
      <inertia ixx="0.2" iyy="0.2" izz="0.25" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0.05 0 0.1"/><geometry><box size="0.4 0.26 0.1"/></geometry></collision>
  </link>
  <joint name="battery_joint" type="fixed"><parent link="base"/><child link="battery"/>
    <origin xyz="-0.1 0 0.05" rpy="0 0 1.5707963267948966"/></joint>
  <link name="battery"><inertial><mass value="2"/>
    <inertia ixx="0.02" iyy="0.03" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="left_joint" type="continuous"><parent link="base"/><child link="left_wheel"/>
    <origin xyz="0 0.15 0.05" rpy="-1.5707963267948966 0 0"/><axis xyz="0 0 1"/>
    <dynamics damping="0.02" friction="0.1"/></joint>
  <link name="left_wheel">
    <inertial><mass value="0.5"/><inertia ixx="4e-4" iyy="4e-4" izz="6e-4" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><cylinder radius="0.05" length="0.02"/></geometry></collision></link>
  <joint name="right_joint" type="continuous"><parent link="base"/><child link="right_wheel"/>
    <origin xyz="0 -0.15 0.05" rpy="-1.5707963267948966 0 0"/><axis xyz="0 0 1"/>
    <limit effort="3" velocity="20"/><dynamics damping="0.02" friction="0.1"/></joint>
  <link name="right_wheel">
    <inertial><mass value="0.5"/><inertia ixx="4e-4" iyy="4e-4" izz="6e-4" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><cylinder radius="0.05" length="0.02"/></geometry></collision></link>
  <joint name="caster_joint" type="continuous"><parent link="base"/><child link="caster"/>
    <origin xyz="-0.12 0 0.02"/></joint>
  <link name="caster"/>
PLUGIN</robot>
)";
const std::string kPlugin = R"(<gazebo><plugin filename="libgazebo_ros_diff_drive.so" name="drive">
  <left_joint>left_joint</left_joint><right_joint>right_joint</right_joint>
  <wheel_separation>0.3</wheel_separation><wheel_diameter>0.1</wheel_diameter>
  <max_linear_velocity>0.8</max_linear_velocity></plugin></gazebo>
)";
const std::string kTransmissions = R"(<transmission name="a"><joint name="right_joint"/></transmission>
<transmission name="b"><joint name="left_joint"/></transmission>
)";

const std::string kSdf = R"(<sdf version="1.9"><model name="cart">
  <link name="base"><inertial><pose>0.05 0 0.1 0 0 0</pose><mass>10</mass>
    <inertia><ixx>0.2</ixx><iyy>0.2</iyy><izz>0.25</izz></inertia></inertial>
    <collision name="c"><pose>0.05 0 0.1 0 0 0</pose><geometry><box><size>0.4 0.26 0.1</size></box></geometry></collision></link>
  <frame name="shelf" attached_to="base"><pose>-0.1 0 0 0 0 0</pose></frame>
  <link name="battery"><pose relative_to="shelf">0 0 0.05 0 0 90</pose><inertial><mass>2</mass>
    <inertia><ixx>0.02</ixx><iyy>0.03</iyy><izz>0.01</izz></inertia></inertial></link>
  <joint name="battery_joint" type="fixed"><parent>base</parent><child>battery</child></joint>
  WHEELS
  <plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
    <left_joint>left_joint</left_joint><right_joint>right_joint</right_joint>
    <max_linear_velocity>0.8</max_linear_velocity></plugin>
</model></sdf>
)";

const std::string kMjcf = R"(<mujoco model="cart">
  <compiler angle="degree"/>
  <default><geom contype="1"/><default class="wheel"><joint axis="0 0 1" damping="0.02" frictionloss="0.1"/>
    <geom type="cylinder" size="0.05 0.01" mass="0"/></default></default>
  <worldbody><body name="base"><freejoint/>
    <inertial pos="0.05 0 0.1" mass="10" diaginertia="0.2 0.2 0.25"/>
    <geom type="box" pos="0.05 0 0.1" size="0.2 0.13 0.05"/>
    <body name="battery" pos="-0.1 0 0.05" euler="0 0 90"><inertial pos="0 0 0" mass="2" diaginertia="0.02 0.03 0.01"/></body>
    <body name="left_wheel" pos="0 0.15 0.05" euler="-90 0 0" childclass="wheel">
      <inertial pos="0 0 0" mass="0.5" diaginertia="4e-4 4e-4 6e-4"/><joint name="left_joint"/><geom/></body>
    <body name="right_wheel" pos="0 -0.15 0.05" euler="-90 0 0" childclass="wheel">
      <inertial pos="0 0 0" mass="0.5" diaginertia="4e-4 4e-4 6e-4"/><joint name="right_joint"/><geom/></body>
  </body></worldbody>
  <actuator><velocity joint="left_joint" ctrlrange="-16 16"/><velocity joint="right_joint" ctrlrange="-16 16"/></actuator>
</mujoco>
)";

std::string with(std::string text, const std::string& mark, const std::string& part) {
  return text.replace(text.find(mark), mark.size(), part);
}

std::string sdf() {
  std::string wheels;
  for (const std::string side : {"left", "right"})
    wheels +=
        "<link name='" + side + "_wheel'><pose>0 " + (side == "left" ? "0.15" : "-0.15") +
        " 0.05 -1.5707963267948966 0 "
        "0</pose><inertial><mass>0.5</mass><inertia><ixx>4e-4</ixx><iyy>4e-4</iyy>"
        "<izz>6e-4</izz></inertia></inertial><collision name='c'><geometry><cylinder><radius>0.05</radius>"
        "<length>0.02</length></cylinder></geometry></collision></link><joint name='" +
        side + "_joint' type='revolute'><parent>base</parent><child>" + side +
        "_wheel</child><axis><xyz>0 0 "
        "1</xyz><use_parent_model_frame>false</use_parent_model_frame><dynamics><damping>0.02</"
        "damping><friction>0.1</friction>"
        "</dynamics></axis></joint>\n";
  return with(with(kSdf, "0 0 90</pose>", "0 0 1.5707963267948966</pose>"), "WHEELS", wheels);
}

std::map<std::string, std::string> values_of(const RobotDraft& draft) {
  std::map<std::string, std::string> values;
  for (const DraftValue& value : draft.values) {
    values[value.key] = value.text;
    EXPECT_FALSE(value.origin.empty()) << value.key;
  }
  return values;
}

void expect_cart(const RobotDraft& draft) {
  auto values = values_of(draft);
  EXPECT_EQ(draft.name, "cart");
  const auto expect = [&](const char* key, double value) {
    ASSERT_TRUE(values.contains(key)) << key;
    EXPECT_NEAR(std::stod(values[key]), value, 1e-6 * std::abs(value)) << key;
  };
  expect("geometry.wheel_radius_m", 0.05);
  expect("geometry.half_track_m", 0.15);
  expect("geometry.center_of_mass_offset_m", (10 * 0.05 - 2 * 0.1) / 12);
  expect("inertia.chassis_mass_kg", 12);
  // Parallel axes: 0.25 + 10 (0.05 - 0.025)^2 + 0.01 + 2 (0.1 + 0.025)^2.
  expect("inertia.chassis_yaw_inertia_kg_m2", 0.25 + 10 * 0.025 * 0.025 + 0.01 + 2 * 0.125 * 0.125);
  expect("inertia.wheel_mass_kg", 0.5);
  expect("inertia.wheel_axle_inertia_kg_m2", 6e-4);
  expect("inertia.wheel_diameter_inertia_kg_m2", 4e-4);
  expect("motor.viscous_friction_Nm_s_rad", 0.02);
  expect("motor.friction_torque_Nm", 0.1);
  expect("limits.speed_m_s", 0.8);
}

TEST(ModelFiles, UrdfSdfAndMjcfOfOneRobotGiveTheValuesByHand) {
  const ScratchDirectory scratch;
  expect_cart(draft_from({scratch.write("cart.urdf", with(kUrdf, "PLUGIN", kPlugin))}, {}));
  expect_cart(draft_from({scratch.write("cart.sdf", sdf())}, {}));
  expect_cart(draft_from({scratch.write("cart.xml", kMjcf)}, {}));
}

TEST(ModelFiles, OfAWorldTheModelThatDrivesIsRead) {
  const ScratchDirectory scratch;
  const std::string floor =
      "<world name='w'><model name='floor'><link name='l'/></model><model name=\"cart\">";
  const std::string world = with(with(sdf(), "<model name=\"cart\">", floor), "</sdf>", "</world></sdf>");
  expect_cart(draft_from({scratch.write("world.sdf", world)}, {}));
}

TEST(ModelFiles, FootprintIsTheHullOfTheCollisionShapes) {
  const ScratchDirectory scratch;
  auto values = values_of(draft_from({scratch.write("cart.urdf", with(kUrdf, "PLUGIN", kPlugin))}, {}));
  // The box reaches from -0.15 to 0.25 m, the wheels to 0.16 m at each side.
  const Document corners = Document::parse(values["footprint.polygon_m"], "");
  double front_m = 0, back_m = 0, left_m = 0;
  for (const Node& corner : corners.root().items()) {
    front_m = std::max(front_m, corner.items()[0].number());
    back_m = std::min(back_m, corner.items()[0].number());
    left_m = std::max(left_m, corner.items()[1].number());
  }
  EXPECT_NEAR(front_m, 0.25, 1e-6);
  EXPECT_NEAR(back_m, -0.15, 1e-6);
  EXPECT_NEAR(left_m, 0.16, 1e-6);
}

TEST(ModelFiles, DriveWheelsAreThoseOfTransmissionsOrNamed) {
  const ScratchDirectory scratch;
  const std::string transmissions = scratch.write("a.urdf", with(kUrdf, "PLUGIN", kTransmissions));
  EXPECT_NEAR(std::stod(values_of(draft_from({transmissions}, {}))["geometry.center_of_mass_offset_m"]),
              0.025, 1e-9);
  const std::string bare = scratch.write("b.urdf", with(kUrdf, "PLUGIN", ""));
  try {
    static_cast<void>(draft_from({bare}, {}));
    ADD_FAILURE();
  } catch (const ConfigError& error) {
    EXPECT_NE(error.detail().accepted.find(
                  "--wheels LEFT,RIGHT with two of: left_joint, right_joint, caster_joint"),
              std::string::npos)
        << error.what();
  }
  EXPECT_EQ(values_of(draft_from({bare}, {"left_joint", "right_wheel"}))["geometry.half_track_m"], "0.15");
}

TEST(ModelFiles, MeshesLeaveTheFootprintOutAndSaySo) {
  const ScratchDirectory scratch;
  const std::string mesh =
      with(with(kUrdf, "PLUGIN", kPlugin), R"(<box size="0.4 0.26 0.1"/>)", R"(<mesh filename="a.stl"/>)");
  const RobotDraft draft = draft_from({scratch.write("cart.urdf", mesh)}, {});
  EXPECT_FALSE(values_of(draft).contains("footprint.polygon_m"));
  EXPECT_TRUE(std::ranges::any_of(draft.notes, [](const std::string& note) {
    return note.find("footprint is left out") != std::string::npos;
  }));
}

TEST(ModelFiles, SolidsWithoutInertialHaveTheMassOfTheirGeoms) {
  const ScratchDirectory scratch;
  const std::string solid =
      with(kMjcf, R"(<inertial pos="0.05 0 0.1" mass="10" diaginertia="0.2 0.2 0.25"/>)", "");
  auto values = values_of(draft_from({scratch.write("cart.xml", solid)}, {}));
  const double box_kg = 1000 * 0.4 * 0.26 * 0.1;
  EXPECT_NEAR(std::stod(values["inertia.chassis_mass_kg"]), box_kg + 2, 1e-4);
  const double apart = 0.15 * 0.15 * box_kg * 2 / (box_kg + 2);
  EXPECT_NEAR(std::stod(values["inertia.chassis_yaw_inertia_kg_m2"]),
              box_kg * (0.4 * 0.4 + 0.26 * 0.26) / 12 + 0.01 + apart, 1e-5);
}

double number_in(const RobotDraft& draft, const std::string& key) {
  auto values = values_of(draft);
  EXPECT_TRUE(values.contains(key)) << key;
  return values.contains(key) ? std::stod(values[key]) : 0.0;
}

std::string refusal_of(const std::string& file) {
  try {
    static_cast<void>(draft_from({file}, {}));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(ModelFiles, SpeedsOfVelocityActuatorsAreSeenThroughTheirGears) {
  const ScratchDirectory scratch;
  const auto geared = [&](const std::string& more) {
    std::string text = kMjcf;
    for (const std::string side : {"left", "right"})
      text = with(text, "\"" + side + "_joint\" ctrlrange", "\"" + side + "_joint\" " + more + " ctrlrange");
    return scratch.write("cart.xml", text);
  };
  // 16 of the transmission are 1.6 rad/s of a wheel with 0.05 m.
  EXPECT_NEAR(number_in(draft_from({geared("gear=\"-10\"")}, {}), "limits.speed_m_s"), 0.08, 1e-9);
  EXPECT_FALSE(values_of(draft_from({geared("ctrllimited=\"false\"")}, {})).contains("limits.speed_m_s"));
  EXPECT_NE(refusal_of(geared("gear=\"\"")).find("one number or more"), std::string::npos);
}

TEST(ModelFiles, AxesOfSdfAreInTheFrameThatTheyName) {
  const ScratchDirectory scratch;
  const std::string own = "<xyz>0 0 1</xyz><use_parent_model_frame>false</use_parent_model_frame>";
  const auto stated = [&](const std::string& axis, const std::string& version) {
    std::string text = with(sdf(), "version=\"1.9\"", "version=\"" + version + "\"");
    for (int side = 0; side < 2; ++side) text = with(text, own, axis);
    return draft_from({scratch.write("cart.sdf", text)}, {});
  };
  // The wheels are turned by a roll: their own z is the y of the base.
  expect_cart(stated("<xyz expressed_in=\"base\">0 1 0</xyz>", "1.9"));
  expect_cart(stated("<xyz expressed_in=\"__model__\">0 1 0</xyz>", "1.9"));
  expect_cart(stated("<xyz expressed_in=\"left_wheel\">0 0 1</xyz>", "1.9"));
  expect_cart(stated("<xyz>0 0 1</xyz>", "1.5"));
  expect_cart(stated("<xyz>0 1 0</xyz>", "1.4"));
}

TEST(ModelFiles, ShapesOfSdfStandInTheFrameThatTheyName) {
  const ScratchDirectory scratch;
  const std::string shelf = with(sdf(), "<pose>0.05 0 0.1 0 0 0</pose><geometry>",
                                 "<pose relative_to=\"shelf\">0.15 0 0.1 0 0 0</pose><geometry>");
  EXPECT_EQ(values_of(draft_from({scratch.write("a.sdf", shelf)}, {}))["footprint.polygon_m"],
            values_of(draft_from({scratch.write("b.sdf", sdf())}, {}))["footprint.polygon_m"]);
}

TEST(ModelFiles, WhatMassesAreMissingIsTold) {
  const ScratchDirectory scratch;
  const std::string nested = with(sdf(), "<frame name=\"shelf\"",
                                  "<model name=\"arm\"><link name=\"l\"/></model><frame name=\"shelf\"");
  const RobotDraft draft = draft_from({scratch.write("cart.sdf", nested)}, {});
  EXPECT_TRUE(std::ranges::any_of(draft.notes, [](const std::string& note) {
    return note.find("<model> is not read: its masses are missing") != std::string::npos;
  }));
  const std::string copies =
      with(kMjcf, "<body name=\"battery\"",
           "<replicate count=\"2\"><geom size=\"1\"/></replicate><body name=\"battery\"");
  EXPECT_NE(refusal_of(scratch.write("cart.xml", copies)).find("<replicate>"), std::string::npos);
}

/// The battery in a frame, the wheels' class and the actuators in two sections: the same cart.
TEST(ModelFiles, FramesAndRepeatedSectionsOfMjcfGiveTheSameRobot) {
  const ScratchDirectory scratch;
  std::string text = with(kMjcf, R"(<body name="battery" pos="-0.1 0 0.05" euler="0 0 90">)",
                          R"(<frame pos="-0.1 0 0" euler="0 0 90"><body name="battery" pos="0 0 0.05">)");
  text = with(text, R"(diaginertia="0.02 0.03 0.01"/></body>)",
              R"(diaginertia="0.02 0.03 0.01"/></body></frame>)");
  text = with(text, R"(<geom type="cylinder" size="0.05 0.01" mass="0"/></default></default>)",
              R"(</default></default><default><default class="wheel">
              <geom type="cylinder" size="0.05 0.01" mass="0"/></default></default>)");
  text =
      with(text, R"(<velocity joint="right_joint")", R"(</actuator><actuator><velocity joint="right_joint")");
  text =
      with(text, R"(<body name="right_wheel")", R"(</body></worldbody><worldbody><body name="right_wheel")");
  text = with(text, "</body>\n  </body></worldbody>\n  <actuator>", "</body>\n  </worldbody>\n  <actuator>");
  // A body of the second section has no parent and no fixed joint; its place is in the world.
  expect_cart(draft_from({scratch.write("cart.xml", text)}, {}));
}

TEST(ModelFiles, TheOwnOrientationWinsOverThatOfTheClass) {
  const ScratchDirectory scratch;
  const std::string classes =
      with(kMjcf, R"(<geom contype="1"/>)",
           R"(<geom contype="1"/><default class="askew"><geom xyaxes="0 1 0 -1 0 0"/></default>)");
  const std::string box = R"(<geom type="box" pos="0.05 0 0.1")";
  const auto length_m = [&](const std::string& more) {
    auto values = values_of(draft_from({scratch.write("cart.xml", with(classes, box, box + more))}, {}));
    const Document corners = Document::parse(values["footprint.polygon_m"], "");
    double front_m = 0;
    for (const Node& corner : corners.root().items()) front_m = std::max(front_m, corner.items()[0].number());
    return front_m;
  };
  EXPECT_NEAR(length_m(""), 0.25, 1e-6);
  EXPECT_NEAR(length_m(R"( class="askew")"), 0.05 + 0.13, 1e-6);  // turned by a quarter
  EXPECT_NEAR(length_m(R"( class="askew" euler="0 0 0")"), 0.25, 1e-6);
}

TEST(ModelFiles, CapsulesIncludeTheirCapsAndSpheresKnowNoRotation) {
  const ScratchDirectory scratch;
  const auto hull = [&](const std::string& shape, const std::string& rpy) {
    std::string text = with(kUrdf, "PLUGIN", kPlugin);
    text = with(text, R"(<origin xyz="0.05 0 0.1"/><geometry><box size="0.4 0.26 0.1"/>)",
                "<origin xyz=\"0.05 0 0.1\" rpy=\"" + rpy + "\"/><geometry>" + shape);
    return values_of(draft_from({scratch.write("cart.urdf", text)}, {}))["footprint.polygon_m"];
  };
  EXPECT_EQ(hull("<sphere radius=\"0.3\"/>", "0 0 0"), hull("<sphere radius=\"0.3\"/>", "0.3 0.4 0.5"));
  const Document corners =
      Document::parse(hull("<capsule radius=\"0.1\" length=\"0.4\"/>", "0 1.5707963267948966 0"), "");
  double front_m = 0;
  for (const Node& corner : corners.root().items()) front_m = std::max(front_m, corner.items()[0].number());
  EXPECT_NEAR(front_m, 0.05 + 0.2 + 0.1, 0.003);  // a circumscribed polygon
}

TEST(ModelFiles, ErrorsNameFileLineAndElement) {
  const ScratchDirectory scratch;
  const auto message = [&](const std::string& text) {
    try {
      static_cast<void>(draft_from({scratch.write("bad.urdf", text)}, {}));
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string good = with(kUrdf, "PLUGIN", kPlugin);
  EXPECT_NE(message(with(good, R"(mass value="10")", R"(mass value="ten")"))
                .find("bad.urdf:4:1: <mass>: found \"ten\""),
            std::string::npos);
  EXPECT_NE(
      message(with(good, R"(iyy="0.2")", R"(iyy="o.2")")).find("bad.urdf:5:1: <inertia>: found \"o.2\""),
      std::string::npos);
  EXPECT_NE(message(with(sdf(), "<iyy>0.2</iyy>", "<iyy>o.2</iyy>")).find("<iyy>: found \"o.2\""),
            std::string::npos);
  EXPECT_NE(message(with(good, "<link name=\"caster\"/>", "<xacro:caster/>")).find("xacro robot.urdf.xacro"),
            std::string::npos);
  EXPECT_NE(message(with(good, "</robot>", "")).find("broken XML"), std::string::npos);
  EXPECT_NE(message(with(good, R"(<child link="caster"/>)", R"(<child link="castor"/>)"))
                .find("the link \"castor\", accepted: a <link> of this file"),
            std::string::npos);
  EXPECT_NE(message(with(good, "<link name=\"caster\"/>", "<link name=\"caster\"/><link name=\"loose\"/>"))
                .find("a second link that no joint holds"),
            std::string::npos);
  EXPECT_NE(message("<world/>").find("<robot> (URDF), <sdf> or <mujoco> (MJCF)"), std::string::npos);
}

/// What init writes is a robot file once the missing values are there, and check lists those until then.
TEST(ModelFiles, DraftsAreRobotFilesThatLackWhatNoSourceStates) {
  const ScratchDirectory scratch;
  const std::string urdf = scratch.write("cart.urdf", with(kUrdf, "PLUGIN", kPlugin));
  const RobotDraft draft = draft_from({urdf}, {});
  const std::string text = draft_text(draft);
  EXPECT_NE(text.find("# missing: motor.resistance_ohm"), std::string::npos);
  try {
    static_cast<void>(read_any_file(scratch.write("robot.yaml", text)));
    ADD_FAILURE();
  } catch (const ConfigError& error) {
    for (const std::string& key : missing_in(draft))
      EXPECT_NE(error.detail().found.find(key), std::string::npos) << key;
  }
  const std::string sheet = scratch.write("motor.yaml",
                                          "motor_sheet: {at: output, gear_ratio: 20, nominal_voltage_V: 12, "
                                          "no_load_speed_rpm: 200, no_load_current_A: 0.2,\n"
                                          "  stall_torque_Nm: 2, stall_current_A: 6}\n");
  const RobotDraft whole = draft_from({urdf, sheet}, {});
  EXPECT_TRUE(missing_in(whole).empty());
  const Robot robot = robot_from(Document::parse(draft_text(whole), "robot.yaml"));
  EXPECT_EQ(robot.motor.left.resistance_ohm, 2.0);
  EXPECT_EQ(robot.motor.left.friction_torque_Nm, 0.1);
  EXPECT_EQ(robot.effects.size(), 1u);
}

}  // namespace
}  // namespace joulepath
