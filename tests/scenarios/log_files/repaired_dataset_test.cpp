#include "scenarios/log_files/repaired_dataset.hpp"

#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "scenarios/any_file.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "tests/scenarios/scratch_directory.hpp"
#include "tests/support/locations.hpp"

namespace joulepath {
namespace {

std::string log_text(double first) {
  std::string text = "time_s,wheel_speed_left_rad_s,wheel_speed_right_rad_s,curL,motor_current_right_A\n";
  for (int i = 0; i < 5; ++i)
    text += std::to_string(0.02 * i) + ",1," + std::to_string(first) + "," + std::to_string(10 + i) + "," +
            std::to_string(2 + i) + "\n";
  return text;
}

class RepairedDataset : public ::testing::Test {
 protected:
  Dataset read() {
    scratch_.write("a.csv", log_text(1));
    scratch_.write("b.csv", log_text(2));
    return read_dataset(
        scratch_.write("d.yaml", "robot: " JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml\n"
                                 "columns: {motor_current_left_A: {from: curL, scale: 0.1, offset: -1}}\n"
                                 "runs: [{file: a.csv, payload_kg: 0}, {file: b.csv, payload_kg: 0}]\n"));
  }
  Dataset again(const Dataset& dataset, std::vector<DataCheck>& checks) {
    describe_repairs(dataset, checks);
    return read_dataset(
        scratch_.write("out/r.yaml", repaired_dataset_text(dataset, checks, scratch_.at("out"))));
  }
  ScratchDirectory scratch_{};
};

TEST_F(RepairedDataset, OneRunsRepairIsOnTopOfWhatTheFileMaps) {
  const Dataset before = read();
  std::vector<DataCheck> checks{
      {.runs = {1}, .run = "b.csv", .columns = {{.column = "motor_current_left_A", .scale = -1}}}};
  const Dataset after = again(before, checks);
  EXPECT_EQ(checks[0].repair,
            "in the run's entry: columns: {motor_current_left_A: {from: \"curL\", scale: -0.1, offset: 1}}");
  EXPECT_EQ(after.runs[0].log.motor_current_A.left, before.runs[0].log.motor_current_A.left);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_DOUBLE_EQ(after.runs[1].log.motor_current_A.left[i], -before.runs[1].log.motor_current_A.left[i]);
}

TEST_F(RepairedDataset, SidesAreExchangedInAllRuns) {
  const Dataset before = read();
  std::vector<DataCheck> checks{
      {.runs = {0, 1},
       .columns = {{.column = "motor_current_left_A", .from = "motor_current_right_A"},
                   {.column = "motor_current_right_A", .from = "motor_current_left_A"}}}};
  const Dataset after = again(before, checks);
  EXPECT_EQ(checks[0].repair.rfind("columns: {motor_current_left_A: {from: \"motor_current_right_A\"}", 0),
            0u)
      << checks[0].repair;
  for (std::size_t r : {0u, 1u}) {
    EXPECT_EQ(after.runs[r].log.motor_current_A.left, before.runs[r].log.motor_current_A.right);
    EXPECT_EQ(after.runs[r].log.motor_current_A.right, before.runs[r].log.motor_current_A.left);
  }
}

TEST_F(RepairedDataset, ADeadColumnIsNotReadAndALostRunIsLeftOut) {
  const Dataset before = read();
  std::vector<DataCheck> checks{
      {.runs = {0}, .run = "a.csv"},
      {.runs = {1}, .run = "b.csv", .columns = {{.column = "motor_current_right_A", .absent = true}}}};
  const Dataset after = again(before, checks);
  EXPECT_EQ(checks[0].repair, "leave the run out");
  ASSERT_EQ(after.runs.size(), 1u);
  EXPECT_NE(after.runs[0].name.find("b.csv"), std::string::npos);
  EXPECT_TRUE(after.runs[0].log.motor_current_A.right.empty());
  EXPECT_FALSE(after.runs[0].log.motor_current_A.left.empty());
}

TEST_F(RepairedDataset, WhereNoRunCanBeRepairedNoDatasetIsWritten) {
  const Dataset before = read();
  const std::vector<DataCheck> checks{{.runs = {0, 1}}};
  EXPECT_THROW(static_cast<void>(repaired_dataset_text(before, checks, scratch_.at("out"))), ConfigError);
}

/// Numbers that no robot has: `check` and `diagnose` name them, other readers refuse the file.
TEST(SuspectDatasets, AreNamedByCheckAndRefusedElsewhere) {
  for (const auto& [name, channel, found] :
       {std::tuple{"currents_in_milliamperes", "motor_current_left_A", "up to 2.41e+04"},
        std::tuple{"log_of_another_robot", "linear_speed_m_s", "a mean speed of 2.403 m/s"},
        std::tuple{"speeds_in_rpm", "wheel_speed_left_rad_s", "up to 1.146e+04"},
        std::tuple{"times_in_microseconds", "time_s", "a sample every 1e+05 s"}}) {
    const std::string file = std::string(JOULEPATH_SOURCE_DIR "/tests/data/suspect/") + name + ".yaml";
    const FileSummary summary = read_any_file(file);
    ASSERT_FALSE(summary.data_checks.empty()) << name;
    EXPECT_EQ(summary.data_checks[0].channel, channel);
    EXPECT_NE(summary.data_checks[0].evidence.find(found), std::string::npos)
        << summary.data_checks[0].evidence;
    try {
      static_cast<void>(read_dataset(file));
      ADD_FAILURE() << name << " was read";
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.detail().mark.line, 4) << name;
      EXPECT_NE(error.detail().found.find(found), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace joulepath
