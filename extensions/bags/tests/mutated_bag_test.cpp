#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <random>

#include "extensions/bags/tests/bag_fixture.hpp"
#include "extensions/bags/tests/chunked_bag.hpp"
#include "scenarios/log_files/run_log.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath::testing {
namespace {

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
      {"e.jsonl", states()},
      {"f.mcap", drive_with_index()}};
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

}  // namespace
}  // namespace joulepath::testing
