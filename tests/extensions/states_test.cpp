// States of VDA 5050 are messages that the extension bags makes a log of: the two meet in the registry.
#include <gtest/gtest.h>

#include "extensions/bags/bag_survey.hpp"
#include "extensions/bags/tests/bag_fixture.hpp"
#include "extensions/vda5050/state_lines.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "scenarios/log_files/run_log.hpp"
#include "scenarios/text/utc_time.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath::testing {
namespace {

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
  const LogTables log = read_bag_log(file, {}, {}, "run");
  EXPECT_TRUE(told(log, "truncated"));
  ASSERT_EQ(log.tables.size(), 1u);
  EXPECT_EQ(*log.tables[0].find("agv_1.agvPosition.x"), (std::vector<double>{0, 1, 2, 3, 4}));
  EXPECT_EQ(log.tables[0].find("agv_1.mobileRobotPosition.x"), nullptr);
  const std::string proposed = suggested_dataset(survey_bag(file), file);
  EXPECT_EQ(proposed.find("batteryCurrent"), std::string::npos) << "these messages have none: " << proposed;
  const Robot robot = nomad();
  const Document document = Document::load(scratch_.write("dataset.yaml", proposed));
  EXPECT_EQ(dataset_from(document, {}, {}, {.robot = &robot}).runs.at(0).log.battery_voltage_V.size(), 5u);
  const RunLog run = read_run_log({{file, {}}}, {}, nomad().geometry, "run");
  EXPECT_EQ(run.trajectory.battery_voltage_V, std::vector<double>(5, 48.0));
  EXPECT_EQ(utc_nanoseconds("1970-01-02T00:00:01.25Z"), std::uint64_t{86'401'250'000'000});
  for (const char* wrong : {"", "2726-05-01T10:00:39Z", "1970-01-02", "1970-13-02T00:00:01Z",
                            "1970-01-02T00:00:01+2", "2026-05-01T12:30:15X", "1970-01-02T00:00:01.x5Z"})
    EXPECT_FALSE(utc_nanoseconds(wrong)) << wrong;
}

}  // namespace
}  // namespace joulepath::testing
