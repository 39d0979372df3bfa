#include "extensions/onboard/log_stream.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "extensions/onboard/write_monitor_event.hpp"
#include "model/config_error.hpp"

namespace joulepath {
namespace {

const Geometry kGeometry{.wheel_radius_m = {0.1, 0.1}, .half_track_m = 0.2};

TEST(LogLines, CsvAndJsonGiveTheSameRow) {
  LogLines csv(kGeometry, "a.csv"), json(kGeometry, "a.jsonl");
  EXPECT_FALSE(
      csv.row("time_s;motor_current_left_A;\"wheel_speed_left_rad_s\";wheel_speed_right_rad_s;else"));
  EXPECT_FALSE(csv.row("# a comment"));
  EXPECT_FALSE(csv.row("\r"));
  const auto a = csv.row("1.5;0.25;3;-4;x\r");
  const auto b = json.row(
      R"({"time_s": 1.5, "motor_current_left_A": 0.25, "wheel_speed_left_rad_s": 3, "wheel_speed_right_rad_s": -4, "else": []})");
  ASSERT_TRUE(a && b);
  for (const MonitorRow& row : {*a, *b}) {
    EXPECT_EQ(row.time_s, 1.5);
    EXPECT_EQ(row.motor_current_A.left, 0.25);
    EXPECT_TRUE(std::isnan(row.motor_current_A.right));
    EXPECT_EQ(row.wheel_speed_rad_s.left, 3);
    EXPECT_EQ(row.wheel_speed_rad_s.right, -4);
  }
}

/// As in a file: which of the two would count is open.
TEST(LogLines, ADoubledColumnIsAnErrorAndADoubledKeyABrokenRow) {
  LogLines csv(kGeometry, "a.csv");
  EXPECT_THROW((void)csv.row("time_s,wheel_speed_left_rad_s,wheel_speed_right_rad_s,wheel_speed_left_rad_s"),
               ConfigError);
  LogLines unknown(kGeometry, "b.csv");
  EXPECT_FALSE(unknown.row("time_s,wheel_speed_left_rad_s,wheel_speed_right_rad_s,note,note"));
  LogLines json(kGeometry, "a.jsonl");
  const auto row = json.row(
      R"({"time_s": 1, "wheel_speed_left_rad_s": 3, "wheel_speed_right_rad_s": 3, "wheel_speed_left_rad_s": 9})");
  ASSERT_TRUE(row);
  EXPECT_TRUE(std::isnan(row->time_s));
  const auto nested = json.row(R"({"time_s": 2, "a": {"time_s": 1, "b": 1}, "b": 2})");
  ASSERT_TRUE(nested);
  EXPECT_EQ(nested->time_s, 2);
}

TEST(LogLines, BodySpeedsGiveWheelSpeeds) {
  LogLines lines(kGeometry, "a.jsonl");
  const auto row = lines.row(R"({"time_s": 0, "linear_speed_m_s": 0.5, "angular_speed_rad_s": 1})");
  ASSERT_TRUE(row);
  EXPECT_NEAR(row->wheel_speed_rad_s.left, 3, 1e-12);
  EXPECT_NEAR(row->wheel_speed_rad_s.right, 7, 1e-12);
}

/// Cut lines, text, missing and surplus cells, broken JSON: a row with what is left, never an error.
TEST(LogLines, NothingInALineIsAnError) {
  LogLines csv(kGeometry, "a.csv"), json(kGeometry, "a.jsonl");
  (void)csv.row("time_s,wheel_speed_left_rad_s,wheel_speed_right_rad_s");
  for (const char* line : {"1", "1,2", "nan,inf,x", ",,,,,,", "1,2,3,4,5", "x", "1e999,0,0", "\xff\xfe\x00"})
    EXPECT_TRUE(csv.row(line)) << line;
  for (const char* line :
       {"{", "{}", R"({"time_s": "1"})", R"({"time_s": null})", R"({"time_s": 1e999})", "{]"})
    EXPECT_TRUE(json.row(line)) << line;
}

TEST(LogLines, AmongJsonRowsAnotherLineIsABrokenRow) {
  LogLines lines(kGeometry, "a.jsonl");
  (void)lines.row(R"({"time_s": 1})");
  for (const char* line : {"[]", "[[[", "time_s", "null"}) {
    const auto row = lines.row(line);
    ASSERT_TRUE(row) << line;
    EXPECT_TRUE(std::isnan(row->time_s)) << line;
  }
}

TEST(LogLines, AHeaderWithoutTimesOrSpeedsIsAnError) {
  for (const char* header :
       {"t,v", "time_s,motor_current_left_A", "wheel_speed_left_rad_s,wheel_speed_right_rad_s",
        "time_s,wheel_speed_left_rad_s", "\x01\x02garbage"}) {
    LogLines lines(kGeometry, "a.csv");
    EXPECT_FALSE(lines.row("# a comment"));
    try {
      (void)lines.row(header);
      ADD_FAILURE() << header;
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.detail().mark.file, "a.csv");
      EXPECT_EQ(error.detail().mark.line, 2);
    }
  }
}

/// A line without an end is refused while it arrives; one that just fits is a row.
TEST(LogLines, ALineIsBounded) {
  constexpr std::size_t kMost = 1u << 20;
  const std::string header = "# a comment\ntime_s,wheel_speed_left_rad_s,wheel_speed_right_rad_s\n";
  for (const std::string& start : {header + "1,2,3,", std::string("\n\n{\"time_s\": 1, \"x\": \"")}) {
    const std::string line = start.substr(start.rfind('\n') + 1);
    std::istringstream endless(start + std::string(4 * kMost, 'x'));
    try {
      LogLines(kGeometry, "a.csv").follow(endless, [](const MonitorRow&) { ADD_FAILURE(); });
      ADD_FAILURE() << start;
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.detail().mark.file, "a.csv");
      EXPECT_EQ(error.detail().mark.line, 3);
    }
    EXPECT_LE(static_cast<std::size_t>(endless.tellg()), start.size() + kMost + 1);

    std::istringstream longest(start + std::string(kMost - line.size(), 'x') + "\n" + line);
    int rows = 0;
    LogLines(kGeometry, "a.csv").follow(longest, [&](const MonitorRow&) { ++rows; });
    EXPECT_EQ(rows, 2);
  }
}

TEST(MonitorJson, IsOneLineWithItsSchemaWhateverTheNumbers) {
  MonitorStatus status{.time_s = 3, .rest_J = kAbsent, .rest_upper_J = kNoLimit};
  for (const MonitorEvent& event : std::vector<MonitorEvent>{
           status, PayloadChanged{}, NotPayload{.reason = "a \"reason\"\n"}, LegExecuted{}}) {
    const std::string line = monitor_json(event);
    EXPECT_EQ(line.find('\n'), std::string::npos);
    EXPECT_EQ(line.rfind("{\"schema\":\"joulepath/monitor/1\",\"event\":", 0), 0u) << line;
    EXPECT_FALSE(monitor_text(event).empty());
  }
}

}  // namespace
}  // namespace joulepath
