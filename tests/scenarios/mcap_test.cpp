#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "scenarios/run_log.hpp"
#include "tests/scenarios/bag_fixture.hpp"
#include "tests/scenarios/chunked_bag.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath::testing {
namespace {

TEST_F(Bags, ChunksOfEveryCompressionReadTheSame) {
  const BagLog plain = read(drive());
  for (const char* compression : {"", "lz4", "zstd"}) {
    const BagLog log = read(chunked(drive(), compression));
    ASSERT_EQ(log.tables.size(), 1u) << compression;
    EXPECT_EQ(log.tables[0].columns, plain.tables[0].columns) << compression;
    EXPECT_TRUE(log.artifacts.empty()) << compression;
  }
}

TEST_F(Bags, ATruncatedBagGivesItsCompleteRecords) {
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
