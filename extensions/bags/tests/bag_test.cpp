#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "extensions/bags/bag_survey.hpp"
#include "extensions/bags/message_numbers.hpp"
#include "extensions/bags/tests/bag_fixture.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "scenarios/log_files/run_log.hpp"
#include "tests/app/program_result.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath::testing {
namespace {

TEST_F(Bags, ABagGivesTheSameRunAsItsColumnsInCsv) {
  const RunLog bag = read_run_log(written(drive()), nomad().geometry);
  std::ostringstream csv;
  csv.precision(17);
  csv << "time_s,linear_speed_m_s,angular_speed_rad_s,position_x_m,position_y_m,heading_rad\n";
  for (int k = 0; k < 200; ++k) {
    const std::uint64_t ns = kStart_ns + static_cast<std::uint64_t>(k) * kSecond_ns / 100;
    csv << static_cast<double>(ns / kSecond_ns) + 1e-9 * static_cast<double>(ns % kSecond_ns) << ','
        << speed_at(k) << ",0.1,1,2,0\n";
  }
  const RunLog same = read_run_log(scratch_.write("run.csv", csv.str()), nomad().geometry);
  EXPECT_EQ(run_log_text(bag.trajectory), run_log_text(same.trajectory));
}

TEST_F(Bags, JointsAreFoundByNameWhateverTheirOrder) {
  McapWriter bag;
  const auto channel = bag.channel(ros("/joints", "sensor_msgs/msg/JointState"));
  bag.message(channel, kStart_ns, joints(kStart_ns, {{"wheel_left", 1.0}, {"wheel_right", 2.0}}));
  bag.message(channel, kStart_ns + 1,
              joints(kStart_ns + kSecond_ns / 2, {{"wheel_right", 4.0}, {"wheel_left", 3.0}}));
  const LogTables log = read(bag.finish());
  ASSERT_EQ(log.tables.size(), 1u);
  const auto* left = log.tables[0].find("/joints.velocity[wheel_left]");
  const auto* right = log.tables[0].find("/joints.velocity[wheel_right]");
  ASSERT_TRUE(left && right);
  EXPECT_EQ(*left, (std::vector<double>{1.0, 3.0}));
  EXPECT_EQ(*right, (std::vector<double>{2.0, 4.0}));
}

/// Not a channel without values, which other channels would then stand in for.
TEST_F(Bags, AMistypedElementOrFieldIsAnError) {
  McapWriter bag;
  const auto channel = bag.channel(ros("/joints", "sensor_msgs/msg/JointState"));
  const auto odom = bag.channel(ros("/joints_odom", "nav_msgs/msg/Odometry"));
  for (int k = 0; k < 100; ++k) {
    const std::uint64_t ns = kStart_ns + static_cast<std::uint64_t>(k) * kSecond_ns / 50;
    bag.message(odom, ns, odometry(ns, 0.1, 0.0));
    bag.message(channel, ns, joints(ns, {{"wheel_left", 1.0}, {"wheel_right", 2.0}}));
  }
  const std::string file = written(bag.finish());
  for (const std::string wrong : {"/joints.velocity[left_wheel]", "/joints.velocities[wheel_left]"}) {
    ColumnSources sources = one("wheel_speed_left_rad_s", wrong);
    sources["wheel_speed_right_rad_s"].from = {"/joints.velocity[wheel_right]"};
    try {
      (void)read_run_log({{file, {}}}, sources, nomad().geometry, "run");
      FAIL() << wrong;
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.detail().key, "columns.wheel_speed_left_rad_s.from");
      EXPECT_EQ(error.detail().found, wrong);
      EXPECT_EQ(error.detail().hint, "") << "the other wheel is no hint";
    }
  }
}

/// A robot of 20 samples with odometry and joints, the arms' too.
std::string odometry_and_joints(const std::vector<std::string>& names) {
  McapWriter bag;
  const auto odom = bag.channel(ros("/odom", "nav_msgs/msg/Odometry"));
  const auto joint_states = bag.channel(ros("/joints", "sensor_msgs/msg/JointState"));
  for (int k = 0; k < 20; ++k) {
    const std::uint64_t ns = kStart_ns + static_cast<std::uint64_t>(k) * kSecond_ns / 50;
    bag.message(odom, ns, odometry(ns, 0.1 * k, 0.2));
    std::vector<std::pair<std::string, double>> velocities;
    for (const std::string& name : names) velocities.emplace_back(name, 1.0 * k + 100.0 * velocities.size());
    bag.message(joint_states, ns, joints(ns, velocities));
  }
  return bag.finish();
}

TEST_F(Bags, AGivenColumnReplacesNoOtherThanItsOwn) {
  const std::string bag = odometry_and_joints({"wheel_left", "wheel_right", "spare"});
  const auto run_with = [&](const ColumnSources& sources) {
    return read_run_log({{written(bag), {}}}, sources, nomad().geometry, "run");
  };
  const RunLog proposed = run_with({});
  const RunLog given = run_with(one("wheel_speed_left_rad_s", "/joints.velocity[spare]"));
  EXPECT_EQ(given.trajectory.wheel_speed_rad_s.left[1], 201.0);
  EXPECT_EQ(given.trajectory.wheel_speed_rad_s.right, proposed.trajectory.wheel_speed_rad_s.right);
  EXPECT_EQ(given.trajectory.linear_speed_m_s, proposed.trajectory.linear_speed_m_s);
  EXPECT_EQ(given.trajectory.heading_rad, proposed.trajectory.heading_rad);
  const auto told = std::ranges::find(given.artifacts, "proposed", &LogArtifact::kind);
  ASSERT_NE(told, given.artifacts.end());
  EXPECT_NE(told->description.find("wheel_speed_right_rad_s"), std::string::npos);
  EXPECT_EQ(told->description.find("wheel_speed_left_rad_s"), std::string::npos);
  EXPECT_EQ(std::ranges::count(proposed.artifacts, "proposed", &LogArtifact::kind), 0);
  ColumnSources absent;
  absent["position_x_m"].is_absent = absent["heading_rad"].is_absent = true;
  const RunLog without = run_with(absent);
  EXPECT_TRUE(without.trajectory.position_x_m.empty() && without.trajectory.heading_rad.empty());
  EXPECT_FALSE(without.trajectory.position_y_m.empty());
}

/// A heading of one topic and a quaternion's part of another would mix.
TEST_F(Bags, AGivenHeadingReplacesTheQuaternionThatIsProposed) {
  const LogTables log = read(drive(), one("heading_rad", "/odom.pose.pose.position.x"));
  EXPECT_TRUE(log.sources.contains("linear_speed_m_s"));
  for (const char* part : kOrientationColumns) EXPECT_FALSE(log.sources.contains(part)) << part;
}

/// Where topics have the same times, their values are those of the messages to the last bit.
TEST_F(Bags, TopicsOfTheSameTimesAreNotChangedByTheirMerging) {
  McapWriter bag;
  const auto odom = bag.channel(ros("/odom", "nav_msgs/msg/Odometry"));
  const auto joint_states = bag.channel(ros("/joints", "sensor_msgs/msg/JointState"));
  for (int k = 0; k < 200; ++k) {
    const std::uint64_t ns = kStart_ns + static_cast<std::uint64_t>(k) * kSecond_ns / 50;
    bag.message(odom, ns, odometry(ns, std::sin(k), 0.2));
    bag.message(joint_states, ns, joints(ns, {{"left", 1.0}, {"right", 2.0}}));
  }
  const RunLog log = read_run_log(written(bag.finish()), nomad().geometry);
  ASSERT_EQ(log.trajectory.linear_speed_m_s.size(), 200u);
  for (std::size_t k = 0; k < 200; ++k)
    EXPECT_EQ(log.trajectory.linear_speed_m_s[k], std::sin(static_cast<double>(k))) << k;
}

TEST_F(Bags, OneWheelAloneIsNotProposed) {
  const std::string file = written(odometry_and_joints({"wheel_left", "caster"}));
  const ColumnSources proposed = suggested_columns(survey_bag(file));
  EXPECT_FALSE(proposed.contains("wheel_speed_left_rad_s"));
  EXPECT_TRUE(proposed.contains("linear_speed_m_s"));
}

TEST_F(Bags, TransformsAndDiagnosticsAreFoundByTheirNames) {
  CdrWriter tf;
  tf.number(std::uint32_t{2});
  for (const auto& [frame, x] : {std::pair{"base_link", 1.5}, {"laser", 9.0}}) {
    header(tf, kStart_ns);
    tf.text(frame);
    for (const double value : {x, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0}) tf.number(value);
  }
  const auto transforms = message_numbers(ros("/tf", "tf2_msgs/msg/TFMessage"));
  transforms->want("transforms[base_link].transform.translation.x");
  transforms->want("transforms[1].transform.translation.x");
  std::vector<double> values;
  transforms->read(tf.bytes(), values);
  EXPECT_EQ(values, (std::vector<double>{1.5, 9.0}));

  CdrWriter diagnostic;
  header(diagnostic, kStart_ns);
  diagnostic.number(std::uint32_t{1}).number(std::uint8_t{0});
  for (const char* text : {"battery", "", ""}) diagnostic.text(text);
  diagnostic.number(std::uint32_t{2}).text("state").text("good").text("voltage").text("24.5");
  const auto status = message_numbers(ros("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray"));
  status->want("status[battery].values[voltage].value");
  status->want("status[battery].values[state].value");
  status->read(diagnostic.bytes(), values);
  EXPECT_EQ(values[0], 24.5);
  EXPECT_TRUE(std::isnan(values[1]));
}

TEST_F(Bags, AVendorsMessagesAreReadByFieldPathInCdrAndJson) {
  McapWriter bag;
  const auto cdr = bag.channel({.topic = "/drive",
                                .type = "acme/msg/Drive",
                                .schema_encoding = "ros2msg",
                                .schema = "uint8 MODE=1\nMotor motor_left  # by the wall\nMotor motor_right\n"
                                          "===\nMSG: acme/Motor\nbool on\nfloat32 current\nint16[2] raw\n",
                                .encoding = "cdr"});
  const auto json = bag.channel({.topic = "/state", .type = "acme.State", .encoding = "json"});
  for (int k = 0; k < 3; ++k) {
    CdrWriter drive_message;
    for (const float current : {1.5f, 2.5f})
      drive_message.number(std::uint8_t{1})
          .number(current + static_cast<float>(k))
          .number(std::int16_t{1})
          .number(std::int16_t{2});
    const std::uint64_t time_ns = kStart_ns + static_cast<std::uint64_t>(k) * kSecond_ns;
    bag.message(cdr, time_ns, drive_message.bytes());
    bag.message(json, time_ns, R"({"motor": {"left": {"speed": )" + std::to_string(k) + "}}}");
  }
  ColumnSources sources = one("motor_current_right_A", "/drive.motor_right.current");
  sources["wheel_speed_left_rad_s"].from = {"/state.motor.left.speed"};
  const LogTables log = read(bag.finish(), sources);
  ASSERT_EQ(log.tables.size(), 2u);
  EXPECT_EQ(*log.tables[0].find("/state.motor.left.speed"), (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(*log.tables[1].find("/drive.motor_right.current"), (std::vector<double>{2.5, 3.5, 4.5}));
}

TEST_F(Bags, ClockOrderAndRepeatedMessagesAreReported) {
  McapWriter bag;
  const auto odom = bag.channel(ros("/odom", "nav_msgs/msg/Odometry"));
  for (const int k : {0, 2, 1, 3, 3, 4}) {
    const std::uint64_t time_ns = kStart_ns + static_cast<std::uint64_t>(k) * kSecond_ns / 10;
    bag.message(odom, time_ns, odometry(time_ns, 0.1 * k, 0.0));
  }
  const LogTables log = read(bag.finish());
  EXPECT_TRUE(told(log, "out_of_order") && told(log, "repeated"));
  const auto* speed = log.tables[0].find("/odom.twist.twist.linear.x");
  ASSERT_TRUE(speed);
  EXPECT_EQ(speed->size(), 5u);
  EXPECT_TRUE(std::ranges::is_sorted(*speed));

  McapWriter other;
  const auto stamped = other.channel(ros("/odom", "nav_msgs/msg/Odometry"));
  for (std::uint64_t k = 0; k < 3; ++k)
    other.message(stamped, kStart_ns + k * kSecond_ns, odometry(100 * kSecond_ns + k * kSecond_ns, 0.0, 0.0));
  const LogTables shifted = read(other.finish());
  EXPECT_TRUE(told(shifted, "other_clock"));
  EXPECT_EQ(shifted.tables[0].columns[0][0], 1e-9 * static_cast<double>(kStart_ns));
}

/// A localization does not use the wheels alone, so its pose is a measurement; a first guess is none.
TEST_F(Bags, APoseOfALocalizationIsProposedBeforeThatOfTheOdometry) {
  for (const int poses : {1, 60}) {
    McapWriter bag;
    const auto odom = bag.channel(ros("/odom", "nav_msgs/msg/Odometry"));
    const auto located = bag.channel(ros("/amcl_pose", "geometry_msgs/msg/PoseWithCovarianceStamped"));
    for (int k = 0; k < 100; ++k) {
      const std::uint64_t ns = kStart_ns + static_cast<std::uint64_t>(k) * kSecond_ns / 50;
      bag.message(odom, ns, odometry(ns, 0.1, 0.0));
      if (k < poses) bag.message(located, ns, odometry(ns, 0.1, 0.0));
    }
    const ColumnSources columns = suggested_columns(survey_bag(written(bag.finish())));
    EXPECT_EQ(columns.at("position_x_m").from.front(),
              poses > 1 ? "/amcl_pose.pose.pose.position.x" : "/odom.pose.pose.position.x");
    EXPECT_EQ(columns.at("linear_speed_m_s").from.front(), "/odom.twist.twist.linear.x");
  }
}

/// Runs of one day: the second one begins four minutes after the first.
TEST_F(Bags, ProposedRunsCountTheirTimeFromTheFirstStamp) {
  const auto bag_at = [](std::uint64_t begin_ns) {
    McapWriter bag;
    const auto odom = bag.channel(ros("/odom", "nav_msgs/msg/Odometry"));
    for (std::uint64_t k = 0; k < 20; ++k)
      bag.message(odom, begin_ns + k * kSecond_ns / 50, odometry(begin_ns, 0.1, 0.0));
    return bag.finish();
  };
  const std::string first = written(bag_at(kStart_ns), "a.mcap");
  const std::string second = written(bag_at(kStart_ns + 240 * kSecond_ns), "b.mcap");
  const std::string said = run_program(scratch_, "check '" + second + "' '" + first + "'").out;
  const auto of = [&](const std::string& file) { return said.find(file); };
  EXPECT_LT(of("b.mcap"), said.find("start_time_s: 240\n")) << said;
  EXPECT_LT(of("a.mcap"), said.find("start_time_s: 0\n")) << said;
  EXPECT_NE(said.find("start_time_s: 240\n"), std::string::npos) << said;
  EXPECT_NE(said.find("start_time_s: 0\n"), std::string::npos) << said;
  EXPECT_EQ(run_program(scratch_, "check '" + first + "'").out.find("start_time_s"), std::string::npos);
}

TEST_F(Bags, TheProposedDatasetReadsTheBag) {
  const std::string file = written(drive());
  const Robot robot = nomad();
  std::string text = suggested_dataset(survey_bag(file), file);
  const auto read = [&] {
    return dataset_from(Document::load(scratch_.write("dataset.yaml", text)), {}, {}, {.robot = &robot})
        .runs.at(0);
  };
  EXPECT_EQ(read().log.size(), 200u);
  EXPECT_FALSE(read().payload_known);
  const auto comment = text.find("# payload_kg: 0");
  ASSERT_NE(comment, std::string::npos) << text;
  text.replace(comment, 15, "payload_kg: 4");
  EXPECT_EQ(read().payload.at(0).payload_kg, 4.0);
}

}  // namespace
}  // namespace joulepath::testing
