#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "scenarios/run_log.hpp"
#include "tests/scenarios/bag_fixture.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath::testing {
namespace {

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

TEST_F(Bags, MutatedBagsAreReadOrRefused) {
  std::mt19937 random(7);
  for (const char* compression : {"none", "lz4", "zstd"}) {
    const std::string whole = compression == std::string("none") ? drive() : chunked(drive(), compression);
    for (int i = 0; i < 300; ++i) {
      std::string broken = whole;
      for (int n = 0; n < 4; ++n) {
        const std::size_t range = i % 2 == 0 ? 3000 : broken.size();
        broken[random() % std::min(range, broken.size())] = static_cast<char>(random());
      }
      try {
        (void)read_run_log(written(broken), nomad().geometry);
      } catch (const ConfigError&) {
      }
    }
  }
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

}  // namespace
}  // namespace joulepath::testing
