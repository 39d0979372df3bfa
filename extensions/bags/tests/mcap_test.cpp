#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "extensions/bags/bag_export.hpp"
#include "extensions/bags/bag_survey.hpp"
#include "extensions/bags/tests/bag_fixture.hpp"
#include "extensions/bags/tests/chunked_bag.hpp"
#include "model/kinematics.hpp"
#include "scenarios/any_file.hpp"
#include "scenarios/log_files/run_log.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath::testing {
namespace {

TEST_F(Bags, ChunksOfEveryCompressionReadTheSame) {
  const LogTables plain = read(drive());
  for (const char* compression : {"", "lz4", "zstd"}) {
    const LogTables log = read(chunked(drive(), compression));
    ASSERT_EQ(log.tables.size(), 1u) << compression;
    EXPECT_EQ(log.tables[0].columns, plain.tables[0].columns) << compression;
    EXPECT_TRUE(log.artifacts.empty()) << compression;
  }
}

TEST_F(Bags, ABagWithAnIndexReadsAsOneWithoutChunks) {
  const LogTables plain = read(drive()), indexed = read(drive_with_index());
  EXPECT_EQ(indexed.tables.at(0).columns, plain.tables.at(0).columns);
  EXPECT_TRUE(indexed.artifacts.empty());
}

std::uint32_t check_sum_of(const std::string& bytes, std::size_t from, std::size_t size) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data()) + from, size));
}

/// Every message of a bag by the way of its index: footer, chunk index, message index, message.
std::vector<std::uint64_t> times_by_index(const std::string& bag, std::size_t chunk_index) {
  std::vector<std::uint64_t> times;
  const auto start = number_at<std::uint64_t>(bag, chunk_index + 9 + 16);
  const auto offsets_bytes = number_at<std::uint32_t>(bag, chunk_index + 9 + 32);
  for (std::size_t k = 0; k < offsets_bytes; k += 10) {
    const auto channel = number_at<std::uint16_t>(bag, chunk_index + 9 + 36 + k);
    const auto index = number_at<std::uint64_t>(bag, chunk_index + 9 + 36 + k + 2);
    EXPECT_EQ(bag[index], '\x07');
    EXPECT_EQ(number_at<std::uint16_t>(bag, index + 9), channel);
    for (std::size_t n = 0; n < number_at<std::uint32_t>(bag, index + 11); n += 16) {
      times.push_back(number_at<std::uint64_t>(bag, index + 15 + n));
      const std::size_t message = start + 9 + 40 + number_at<std::uint64_t>(bag, index + 15 + n + 8);
      EXPECT_EQ(bag[message], '\x05');
      EXPECT_EQ(number_at<std::uint16_t>(bag, message + 9), channel);
      EXPECT_EQ(number_at<std::uint64_t>(bag, message + 15), times.back());
    }
  }
  return times;
}

/// By the format's specification; python/tests/test_bags.py asks another reader.
TEST_F(Bags, TheIndexLeadsToEveryMessage) {
  McapWriter writer;
  const auto odom = writer.channel(ros("/odom", "nav_msgs/msg/Odometry"));
  const auto other = writer.channel(ros("/other", "nav_msgs/msg/Odometry"));
  constexpr std::uint64_t kMessages = 4000;  // about 3 MiB
  for (std::uint64_t k = 0; k < kMessages; ++k)
    writer.message(k % 3 == 0 ? other : odom, k, odometry(k, 0.1, 0));
  const std::string bag = writer.finish();
  const std::size_t footer = bag.size() - 8 - 29;
  ASSERT_EQ(bag[footer], '\x02');
  const auto summary = number_at<std::uint64_t>(bag, footer + 9),
             offsets = number_at<std::uint64_t>(bag, footer + 17);
  EXPECT_EQ(number_at<std::uint32_t>(bag, footer + 25), check_sum_of(bag, summary, footer + 25 - summary));
  std::vector<std::uint64_t> times;
  std::uint64_t statistics = 0;
  std::string kinds;
  for (std::size_t at = summary; at < offsets; at += 9 + number_at<std::uint64_t>(bag, at + 1)) {
    kinds += bag[at];
    if (bag[at] == '\x08') {
      const std::vector<std::uint64_t> of_chunk = times_by_index(bag, at);
      times.insert(times.end(), of_chunk.begin(), of_chunk.end());
      const auto chunk = number_at<std::uint64_t>(bag, at + 9 + 16);
      EXPECT_EQ(number_at<std::uint32_t>(bag, chunk + 9 + 24),
                check_sum_of(bag, chunk + 9 + 40, number_at<std::uint64_t>(bag, chunk + 9 + 16)));
    }
    if (bag[at] == '\x0B') statistics = number_at<std::uint64_t>(bag, at + 9);
  }
  EXPECT_EQ(kinds.substr(0, 5), "\x03\x03\x04\x04\x0B");
  EXPECT_GE(kinds.size(), 5u + 3u);  // several chunks
  EXPECT_EQ(statistics, kMessages);
  std::ranges::sort(times);
  ASSERT_EQ(times.size(), kMessages);
  for (std::uint64_t k = 0; k < kMessages; ++k) EXPECT_EQ(times[k], k);
}

TEST_F(Bags, MessagesCompressedOneByOneReadTheSame) {
  McapWriter plain, packed;
  const auto odom = ros("/odom", "nav_msgs/msg/Odometry");
  const auto to_plain = plain.channel(odom), to_packed = packed.channel(odom);
  for (int k = 0; k < 5; ++k) {
    const std::uint64_t time_ns = kStart_ns + static_cast<std::uint64_t>(k) * kSecond_ns / 10;
    const std::string message = odometry(time_ns, speed_at(k), 0.1);
    std::string frame(ZSTD_compressBound(message.size()), '\0');
    frame.resize(ZSTD_compress(frame.data(), frame.size(), message.data(), message.size(), 1));
    plain.message(to_plain, time_ns, message);
    packed.message(to_packed, time_ns, frame);
  }
  packed.message(to_packed, kStart_ns + kSecond_ns, std::string_view("\x28\xB5\x2F\xFD cut off", 12));
  const LogTables log = read(packed.finish());
  EXPECT_TRUE(told(log, "broken"));
  EXPECT_EQ(log.tables.at(0).columns, read(plain.finish()).tables.at(0).columns);
}

TEST_F(Bags, ALogThatIsWrittenAsABagReadsBackToTheLastBit) {
  const Geometry geometry = nomad().geometry;
  Trajectory log;
  for (int k = 0; k < 200; ++k) {
    log.time_s.push_back(0.01 * (k + 1));
    log.wheel_speed_rad_s.left.push_back(3 * std::sin(0.05 * k));
    log.wheel_speed_rad_s.right.push_back(2.5 * std::sin(0.05 * k + 0.1));
    log.motor_current_A.left.push_back(1.0 / (k + 3));
    log.battery_voltage_V.push_back(24.0 - 1e-3 * k);
  }
  ColumnSources sources;
  for (const char* name :
       {"wheel_speed_left_rad_s", "wheel_speed_right_rad_s", "motor_current_left_A", "battery_voltage_V"})
    sources[name].from = {std::string("/log/power.") + name};
  sources["linear_speed_m_s"].from = {"/log/odom.twist.twist.linear.x"};
  const std::string file = written(log_bag(log, geometry), "log.mcap");
  const Trajectory again = read_run_log({{file, {}}}, sources, geometry, "run").trajectory;
  ASSERT_EQ(again.size(), log.size());
  for (std::size_t i = 0; i < log.size(); ++i) EXPECT_NEAR(again.time_s[i], log.time_s[i], 1e-9);
  EXPECT_EQ(again.wheel_speed_rad_s.left, log.wheel_speed_rad_s.left);
  EXPECT_EQ(again.wheel_speed_rad_s.right, log.wheel_speed_rad_s.right);
  EXPECT_EQ(again.motor_current_A.left, log.motor_current_A.left);
  EXPECT_EQ(again.battery_voltage_V, log.battery_voltage_V);
  const Trajectory alone = read_run_log(file, geometry).trajectory;  // no columns are named
  EXPECT_EQ(alone.motor_current_A.left, log.motor_current_A.left);
  EXPECT_EQ(alone.battery_voltage_V, log.battery_voltage_V);
  EXPECT_EQ(alone.wheel_speed_rad_s.left, log.wheel_speed_rad_s.left);
  const double expected_m_s =
      body_twist(geometry, Sided<double>{log.wheel_speed_rad_s.left[70], log.wheel_speed_rad_s.right[70]})
          .speed_m_s;
  EXPECT_NEAR(again.linear_speed_m_s[70], expected_m_s, 1e-9);
}

TEST_F(Bags, ABagThatEndsAnywhereGivesWhatIsWhole) {
  const std::string whole = drive();
  std::size_t before = 0;
  for (std::size_t size = 9; size + 60 < whole.size(); size += 997) {
    std::size_t rows = 0;
    try {
      const LogTables log = read(whole.substr(0, size));
      EXPECT_TRUE(told(log, "truncated")) << size;
      rows = log.tables[0].rows();
    } catch (const ConfigError&) {
    }
    EXPECT_GE(rows, before) << size;
    before = rows;
  }
  EXPECT_GT(before, 190u);
}

TEST_F(Bags, ABagWithoutAMessageIsAnErrorOfCheck) {
  const std::string whole = drive();
  std::size_t size = whole.size();
  const auto messages = [&] { return survey_bag(written(whole.substr(0, size))).topics.at(0).messages; };
  while (messages() > 0) size = size * 9 / 10;
  const std::string file = written(whole.substr(0, size));
  try {
    (void)read_any_file(file, "");
    FAIL() << "a bag of " << size << " bytes";
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.detail().found.find("no message: the bag is truncated"), 0u) << error.what();
  }
  try {
    (void)read_bag_log(file, {}, {}, "run");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.detail().found.find("no message: the bag is truncated"), 0u) << error.what();
  }
  McapWriter empty;
  (void)empty.channel(ros("/odom", "nav_msgs/msg/Odometry"));
  EXPECT_THROW((void)read_any_file(written(empty.finish()), ""), ConfigError);
}

TEST_F(Bags, BytesAfterADamagedRecordAreCounted) {
  std::string bag = drive();
  const std::size_t middle = bag.size() / 2, foreign = bag.size() / 8;  // more than one record
  bag.replace(middle, foreign, std::string(foreign, '\xff'));
  const LogTables log = read(bag);
  const auto damage = std::ranges::find(log.artifacts, "truncated", &LogArtifact::kind);
  ASSERT_NE(damage, log.artifacts.end());
  const auto number = damage->description.find("its last ");
  ASSERT_NE(number, std::string::npos) << damage->description;
  EXPECT_NEAR(std::stod(damage->description.substr(number + 9)), static_cast<double>(bag.size() - middle),
              0.1 * static_cast<double>(bag.size()));
}

TEST_F(Bags, AnnouncedSizesAreCheckedBeforeAllocation) {
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

}  // namespace
}  // namespace joulepath::testing
