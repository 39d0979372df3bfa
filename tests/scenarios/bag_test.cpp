#include <gtest/gtest.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zstd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>
#include <sstream>

#include "scenarios/bags/bag_log.hpp"
#include "scenarios/bags/bag_survey.hpp"
#include "scenarios/bags/mcap_writer.hpp"
#include "scenarios/bags/message_numbers.hpp"
#include "scenarios/bags/ros_definitions.hpp"
#include "scenarios/bags/state_lines.hpp"
#include "scenarios/dataset_file.hpp"
#include "scenarios/run_log.hpp"
#include "tests/scenarios/scratch_directory.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

using testing::nomad;

constexpr std::uint64_t kSecond_ns = 1'000'000'000, kStart_ns = 1'700'000'000 * kSecond_ns;

BagChannel ros(const std::string& topic, const std::string& type) {
  return {.topic = topic,
          .type = type,
          .schema_encoding = "ros2msg",
          .schema = ros_definition(type),
          .encoding = "cdr"};
}

void header(CdrWriter& out, std::uint64_t time_ns) {
  out.number(static_cast<std::int32_t>(time_ns / kSecond_ns))
      .number(static_cast<std::uint32_t>(time_ns % kSecond_ns));
  out.text("odom");
}

std::string odometry(std::uint64_t time_ns, double v, double w) {
  CdrWriter out;
  header(out, time_ns);
  out.text("base");
  for (const double value : {1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0}) out.number(value);
  for (int i = 0; i < 36; ++i) out.number(0.0);
  for (const double value : {v, 0.0, 0.0, 0.0, 0.0, w}) out.number(value);
  for (int i = 0; i < 36; ++i) out.number(0.0);
  return out.bytes();
}

std::string joints(std::uint64_t time_ns, const std::vector<std::pair<std::string, double>>& velocities) {
  CdrWriter out;
  header(out, time_ns);
  out.number(static_cast<std::uint32_t>(velocities.size()));
  for (const auto& [name, velocity] : velocities) out.text(name);
  out.number(std::uint32_t{0});  // no positions
  out.number(static_cast<std::uint32_t>(velocities.size()));
  for (const auto& [name, velocity] : velocities) out.number(velocity);
  out.number(std::uint32_t{0});
  return out.bytes();
}

double speed_at(int k) { return 0.3 * std::sin(0.05 * k); }

/// Two seconds of odometry at 100 Hz.
std::string drive() {
  McapWriter bag;
  const auto odom = bag.channel(ros("/odom", "nav_msgs/msg/Odometry"));
  for (int k = 0; k < 200; ++k) {
    const std::uint64_t time_ns = kStart_ns + static_cast<std::uint64_t>(k) * kSecond_ns / 100;
    bag.message(odom, time_ns + 3'000'000, odometry(time_ns, speed_at(k), 0.1));
  }
  return bag.finish();
}

template <class Number>
void put(std::string& bytes, Number value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

/// The same bag with all its records in one chunk.
std::string chunked(const std::string& bag, const std::string& compression) {
  const std::string records = bag.substr(8, bag.size() - 8 - 8 - 29 - 13);  // less magics, footer, data end
  std::string packed = records;
  if (compression == "zstd") {
    packed.resize(ZSTD_compressBound(records.size()));
    packed.resize(ZSTD_compress(packed.data(), packed.size(), records.data(), records.size(), 3));
  } else if (compression == "lz4") {
    packed.resize(LZ4F_compressFrameBound(records.size(), nullptr));
    packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), records.data(), records.size(), nullptr));
  }
  std::string content;
  put(content, std::uint64_t{0});
  put(content, std::uint64_t{0});
  put(content, static_cast<std::uint64_t>(records.size()));
  put(content, std::uint32_t{0});
  put(content, static_cast<std::uint32_t>(compression.size()));
  content += compression;
  put(content, static_cast<std::uint64_t>(packed.size()));
  content += packed;
  std::string file = bag.substr(0, 8);
  file += '\x06';
  put(file, static_cast<std::uint64_t>(content.size()));
  return file + content + bag.substr(bag.size() - 8 - 29 - 13);
}

class Bags : public ::testing::Test {
 protected:
  std::string written(const std::string& bytes, const std::string& name = "run.mcap") {
    return scratch_.write(name, bytes);
  }
  BagLog read(const std::string& bytes, const ColumnSources& sources = {}) {
    return read_bag_log(written(bytes), {}, sources, "run");
  }
  static ColumnSources one(const std::string& column, const std::string& from) {
    ColumnSources sources;
    sources[column].from = {from};
    return sources;
  }
  static bool told(const BagLog& log, const std::string& kind) {
    for (const LogArtifact& artifact : log.artifacts)
      if (artifact.kind == kind) return true;
    return false;
  }

  ScratchDirectory scratch_{};
};

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

TEST_F(Bags, ChunksOfEveryCompressionReadTheSame) {
  const BagLog plain = read(drive());
  for (const char* compression : {"", "lz4", "zstd"}) {
    const BagLog log = read(chunked(drive(), compression));
    ASSERT_EQ(log.tables.size(), 1u) << compression;
    EXPECT_EQ(log.tables[0].columns, plain.tables[0].columns) << compression;
    EXPECT_TRUE(log.artifacts.empty()) << compression;
  }
}

TEST_F(Bags, ABagThatEndsAnywhereGivesWhatIsWhole) {
  const std::string whole = drive();
  std::size_t before = 0;
  for (std::size_t size = 9; size + 60 < whole.size(); size += 997) {
    std::size_t rows = 0;
    try {
      const BagLog log = read(whole.substr(0, size));
      EXPECT_TRUE(told(log, "truncated")) << size;
      rows = log.tables[0].rows();
    } catch (const ConfigError&) {
    }
    EXPECT_GE(rows, before) << size;
    before = rows;
  }
  EXPECT_GT(before, 190u);
}

/// Two seconds of odometry as rosbag2 writes them into sqlite.
std::string sqlite_drive(const std::string& file) {
  sqlite3* database = nullptr;
  sqlite3_open(file.c_str(), &database);
  const auto run = [&](const char* statement) {
    EXPECT_EQ(sqlite3_exec(database, statement, nullptr, nullptr, nullptr), SQLITE_OK) << statement;
  };
  run("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT)");
  run("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB)");
  run("INSERT INTO topics VALUES(1, '/odom', 'nav_msgs/msg/Odometry', 'cdr'); BEGIN");
  sqlite3_stmt* insert = nullptr;
  sqlite3_prepare_v2(database, "INSERT INTO messages(topic_id, timestamp, data) VALUES(1, ?, ?)", -1, &insert,
                     nullptr);
  for (int k = 0; k < 200; ++k) {
    const std::uint64_t time_ns = kStart_ns + static_cast<std::uint64_t>(k) * kSecond_ns / 100;
    const std::string message = odometry(time_ns, speed_at(k), 0.1);
    sqlite3_bind_int64(insert, 1, static_cast<sqlite3_int64>(time_ns));
    sqlite3_bind_blob(insert, 2, message.data(), static_cast<int>(message.size()), SQLITE_TRANSIENT);
    EXPECT_EQ(sqlite3_step(insert), SQLITE_DONE);
    sqlite3_reset(insert);
  }
  sqlite3_finalize(insert);
  run("COMMIT");
  sqlite3_close(database);
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string states() {
  std::string lines;
  for (int k = 0; k < 40; ++k)
    lines += R"({"timestamp": "2026-05-01T10:00:)" + std::to_string(10 + k) +
             R"(Z", "serialNumber": "agv", "agvPosition": {"x": 1, "y": 0, "theta": 0}, )"
             R"("velocity": {"vx": 0.)" +
             std::to_string(k) + R"(, "omega": 0}, "batteryState": {"batteryVoltage": 48}})" + "\n";
  return lines;
}

/// Bytes changed, a part cut out or doubled, or the end cut off; half of all changes are near the start.
std::string mutated(std::string bytes, std::mt19937& random) {
  const std::size_t range = random() % 2 == 0 ? std::min<std::size_t>(3000, bytes.size()) : bytes.size();
  const std::size_t at = random() % range, length = random() % std::min<std::size_t>(64, bytes.size() - at);
  switch (random() % 8) {
    case 0:
      return bytes.erase(at, length);
    case 1:
      return bytes.insert(at, bytes.substr(at, length));
    case 2:
      return bytes.substr(0, at);
    default:
      for (unsigned n = random() % 6 + 1; n > 0; --n) bytes[random() % range] = static_cast<char>(random());
      return bytes;
  }
}

/// JOULEPATH_MUTATIONS=100000 JOULEPATH_SEED=2 runs more and others.
unsigned number_from_environment(const char* name, unsigned otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? static_cast<unsigned>(std::stoul(text)) : otherwise;
}

TEST_F(Bags, MutatedBagsAreReadOrRefused) {
  const unsigned count = number_from_environment("JOULEPATH_MUTATIONS", 1000);
  std::mt19937 random(number_from_environment("JOULEPATH_SEED", 7));
  const std::vector<std::pair<std::string, std::string>> bags{
      {"a.mcap", drive()},
      {"b.mcap", chunked(drive(), "lz4")},
      {"c.mcap", chunked(drive(), "zstd")},
      {"d.db3", sqlite_drive(scratch_.at("whole.db3"))},
      {"e.jsonl", states()}};
  unsigned read = 0;
  for (unsigned i = 0; i < count; ++i) {
    const auto& [name, whole] = bags[i % bags.size()];
    try {
      (void)read_run_log(written(mutated(whole, random), name), nomad().geometry);
      ++read;
    } catch (const ConfigError&) {
    }
  }
  EXPECT_GT(read, count / 10);
  EXPECT_LT(read, count);
}

TEST_F(Bags, AnAnnouncedSizeIsNotAllocated) {
  std::string bag = chunked(drive(), "zstd");
  const std::uint64_t huge = std::uint64_t{1} << 60;
  std::memcpy(bag.data() + 8 + 9 + 16, &huge, sizeof huge);
  EXPECT_THROW((void)read(bag), ConfigError);
  std::string sequence = joints(kStart_ns, {{"left", 1.0}});
  const std::uint32_t many = 0x7fffffff;
  std::memcpy(sequence.data() + sequence.size() - 4, &many, sizeof many);
  McapWriter writer;
  const auto channel = writer.channel(ros("/joints", "sensor_msgs/msg/JointState"));
  writer.message(channel, kStart_ns, sequence);
  EXPECT_THROW((void)read(writer.finish(), one("wheel_speed_left_rad_s", "/joints.velocity[left]")),
               ConfigError);
}

TEST_F(Bags, JointsAreFoundByNameWhateverTheirOrder) {
  McapWriter bag;
  const auto channel = bag.channel(ros("/joints", "sensor_msgs/msg/JointState"));
  bag.message(channel, kStart_ns, joints(kStart_ns, {{"wheel_left", 1.0}, {"wheel_right", 2.0}}));
  bag.message(channel, kStart_ns + 1,
              joints(kStart_ns + kSecond_ns / 2, {{"wheel_right", 4.0}, {"wheel_left", 3.0}}));
  const BagLog log = read(bag.finish());
  ASSERT_EQ(log.tables.size(), 1u);
  const auto* left = log.tables[0].find("/joints.velocity[wheel_left]");
  const auto* right = log.tables[0].find("/joints.velocity[wheel_right]");
  ASSERT_TRUE(left && right);
  EXPECT_EQ(*left, (std::vector<double>{1.0, 3.0}));
  EXPECT_EQ(*right, (std::vector<double>{2.0, 4.0}));
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
  const BagLog log = read(bag.finish(), sources);
  ASSERT_EQ(log.tables.size(), 2u);
  EXPECT_EQ(*log.tables[0].find("/state.motor.left.speed"), (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(*log.tables[1].find("/drive.motor_right.current"), (std::vector<double>{2.5, 3.5, 4.5}));
}

TEST_F(Bags, ClocksOrderAndRepetitionsAreTold) {
  McapWriter bag;
  const auto odom = bag.channel(ros("/odom", "nav_msgs/msg/Odometry"));
  for (const int k : {0, 2, 1, 3, 3, 4}) {
    const std::uint64_t time_ns = kStart_ns + static_cast<std::uint64_t>(k) * kSecond_ns / 10;
    bag.message(odom, time_ns, odometry(time_ns, 0.1 * k, 0.0));
  }
  const BagLog log = read(bag.finish());
  EXPECT_TRUE(told(log, "out_of_order") && told(log, "repeated"));
  const auto* speed = log.tables[0].find("/odom.twist.twist.linear.x");
  ASSERT_TRUE(speed);
  EXPECT_EQ(speed->size(), 5u);
  EXPECT_TRUE(std::ranges::is_sorted(*speed));

  McapWriter other;
  const auto stamped = other.channel(ros("/odom", "nav_msgs/msg/Odometry"));
  for (std::uint64_t k = 0; k < 3; ++k)
    other.message(stamped, kStart_ns + k * kSecond_ns, odometry(100 * kSecond_ns + k * kSecond_ns, 0.0, 0.0));
  const BagLog shifted = read(other.finish());
  EXPECT_TRUE(told(shifted, "other_clock"));
  EXPECT_EQ(shifted.tables[0].columns[0][0], 1e-9 * static_cast<double>(kStart_ns));
}

TEST_F(Bags, TheProposedDatasetReadsTheBag) {
  const std::string file = written(drive());
  const Robot robot = nomad();
  const std::string proposed = scratch_.write("dataset.yaml", suggested_dataset(survey_bag(file), file));
  const Dataset dataset = dataset_from(Document::load(proposed), {}, {}, {.robot = &robot});
  ASSERT_EQ(dataset.runs.size(), 1u);
  EXPECT_EQ(dataset.runs[0].log.size(), 200u);
}

TEST_F(Bags, StatesOfVda5050AreALogPerRobot) {
  std::string lines;
  for (int k = 0; k < 5; ++k)
    for (const char* robot : {"agv_1", "agv_2"})
      lines +=
          R"({"timestamp": "2026-05-01T10:00:0)" + std::to_string(k) + R"(.5Z", "serialNumber": ")" + robot +
          R"(", "agvPosition": {"x": )" + std::to_string(k) +
          R"(, "y": 0, "theta": 0}, "velocity": {"vx": 1, "omega": 0}, "batteryState": {"batteryVoltage": 48}})" +
          "\n";
  const std::string file = scratch_.write("day.jsonl", lines + "{\"timestamp\": \"2026-0");
  EXPECT_EQ(survey_bag(file).topics.size(), 2u);
  const BagLog log = read_bag_log(file, {}, {}, "run");
  EXPECT_TRUE(told(log, "truncated"));
  ASSERT_EQ(log.tables.size(), 1u);
  EXPECT_EQ(*log.tables[0].find("agv_1.agvPosition.x"), (std::vector<double>{0, 1, 2, 3, 4}));
  EXPECT_EQ(log.tables[0].find("agv_1.mobileRobotPosition.x"), nullptr);
  const RunLog run = read_run_log({{file, {}}}, {}, nomad().geometry, "run");
  EXPECT_EQ(run.trajectory.battery_voltage_V, std::vector<double>(5, 48.0));
  EXPECT_EQ(utc_nanoseconds("1970-01-02T00:00:01.25Z"), std::uint64_t{86'401'250'000'000});
  for (const char* wrong : {"", "2726-05-01T10:00:39Z", "1970-01-02", "1970-13-02T00:00:01Z",
                            "1970-01-02T00:00:01", "1970-01-02T00:00:01.x5Z"})
    EXPECT_FALSE(utc_nanoseconds(wrong)) << wrong;
}

}  // namespace
}  // namespace joulepath
