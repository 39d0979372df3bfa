#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "extensions/bags/bag_log.hpp"
#include "extensions/bags/mcap_writer.hpp"
#include "extensions/bags/ros_definitions.hpp"
#include "extensions/bags/tests/chunked_bag.hpp"
#include "tests/scenarios/scratch_directory.hpp"

namespace joulepath::testing {

inline constexpr std::uint64_t kSecond_ns = 1'000'000'000, kStart_ns = 1'700'000'000 * kSecond_ns;

inline MessageChannel ros(const std::string& topic, const std::string& type) {
  return {.topic = topic,
          .type = type,
          .schema_encoding = "ros2msg",
          .schema = ros_definition(type),
          .encoding = "cdr"};
}

inline void header(CdrWriter& out, std::uint64_t time_ns) {
  out.number(static_cast<std::int32_t>(time_ns / kSecond_ns))
      .number(static_cast<std::uint32_t>(time_ns % kSecond_ns));
  out.text("odom");
}

inline std::string odometry(std::uint64_t time_ns, double v, double w) {
  CdrWriter out;
  header(out, time_ns);
  out.text("base");
  for (const double value : {1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0}) out.number(value);
  for (int i = 0; i < 36; ++i) out.number(0.0);
  for (const double value : {v, 0.0, 0.0, 0.0, 0.0, w}) out.number(value);
  for (int i = 0; i < 36; ++i) out.number(0.0);
  return out.bytes();
}

inline std::string joints(std::uint64_t time_ns,
                          const std::vector<std::pair<std::string, double>>& velocities) {
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

inline double speed_at(int k) { return 0.3 * std::sin(0.05 * k); }

/// Two seconds of odometry at 100 Hz, as joulepath writes bags.
inline std::string drive_with_index() {
  McapWriter bag;
  const auto odom = bag.channel(ros("/odom", "nav_msgs/msg/Odometry"));
  for (int k = 0; k < 200; ++k) {
    const std::uint64_t time_ns = kStart_ns + static_cast<std::uint64_t>(k) * kSecond_ns / 100;
    bag.message(odom, time_ns + 3'000'000, odometry(time_ns, speed_at(k), 0.1));
  }
  return bag.finish();
}

/// The same drive, every record by itself.
inline std::string drive() { return unchunked(drive_with_index()); }

class Bags : public ::testing::Test {
 protected:
  std::string written(const std::string& bytes, const std::string& name = "run.mcap") {
    return scratch_.write(name, bytes);
  }
  LogTables read(const std::string& bytes, const ColumnSources& sources = {}) {
    return read_bag_log(written(bytes), {}, sources, "run");
  }
  static ColumnSources one(const std::string& column, const std::string& from) {
    ColumnSources sources;
    sources[column].from = {from};
    return sources;
  }
  static bool told(const LogTables& log, const std::string& kind) {
    for (const LogArtifact& artifact : log.artifacts)
      if (artifact.kind == kind) return true;
    return false;
  }

  ScratchDirectory scratch_{};
};

}  // namespace joulepath::testing
