#include "scenarios/log_files/clock_jumps.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/signals/run_signals.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "tests/support/locations.hpp"

namespace joulepath {
namespace {

Run run_with_jump(double jump_s, std::size_t samples = 100) {
  Run run{.name = "a.csv", .start_time_s = 3600.0};
  for (std::size_t i = 0; i < samples; ++i) {
    run.log.time_s.push_back(0.1 * static_cast<double>(i) + (2 * i >= samples ? jump_s : 0.0));
    run.log.payload_kg.push_back(4 * i < 3 * samples ? 1.0 : 2.0);
    run.log.wheel_speed_rad_s.left.push_back(static_cast<double>(i));
    run.log.wheel_speed_rad_s.right.push_back(static_cast<double>(i));
  }
  return run;
}

TEST(ClockJumps, ALogIsCutAtAJumpAndTheJumpIsReported) {
  std::vector<LogArtifact> artifacts;
  const auto runs = split_at_clock_jumps(run_with_jump(1000), artifacts);
  ASSERT_EQ(runs.size(), 2u);
  ASSERT_EQ(artifacts.size(), 1u);
  EXPECT_EQ(artifacts[0].kind, "cut");
  EXPECT_NE(artifacts[0].description.find("1000 s"), std::string::npos) << artifacts[0].description;
  EXPECT_EQ(runs[0].log.size(), 50u);
  EXPECT_EQ(runs[1].log.size(), 50u);
  EXPECT_EQ(runs[1].name, "a.csv (part 2)");
  EXPECT_EQ(runs[1].log.time_s.front(), 0.0);
  EXPECT_EQ(runs[1].log.wheel_speed_rad_s.left.front(), 50.0);
  EXPECT_DOUBLE_EQ(*runs[1].start_time_s, 3600 + 1005.0);
  ASSERT_EQ(runs[1].payload.size(), 2u);
  EXPECT_EQ(runs[1].payload[1].payload_kg, 2.0);
  EXPECT_NEAR(runs[1].payload[1].from_s, 2.5, 1e-9);
}

TEST(ClockJumps, StretchesHaveAllSamplesOfAllColumnsToTheLastBit) {
  joulepath::Run whole{.name = "a.csv"};
  for (std::size_t i = 0; i < 60; ++i) {
    whole.log.time_s.push_back(static_cast<double>(i));
    whole.log.payload_kg.push_back(3.0);
    whole.log.linear_speed_m_s.push_back(i % 2 == 0 ? 0.0 : -0.0);
    whole.log.motor_current_A.left.push_back(0.5 * static_cast<double>(i));
  }
  const Trajectory log = whole.log;
  const auto runs = stretches_between(std::move(whole), {0, 1, 20, 60});  // the first has one sample
  ASSERT_EQ(runs.size(), 2u);
  for (const auto& [run, first] : {std::pair{&runs[0], 1u}, std::pair{&runs[1], 20u}})
    for (std::size_t i = 0; i < run->log.size(); ++i) {
      EXPECT_EQ(run->log.time_s[i], static_cast<double>(i));
      EXPECT_EQ(run->log.payload_kg[i], 3.0);
      EXPECT_EQ(std::signbit(run->log.linear_speed_m_s[i]), std::signbit(log.linear_speed_m_s[first + i]));
      EXPECT_EQ(run->log.motor_current_A.left[i], log.motor_current_A.left[first + i]);
      EXPECT_TRUE(run->log.motor_current_A.right.empty());
    }
  EXPECT_EQ(runs[0].log.size() + runs[1].log.size(), 59u);
}

TEST(ClockJumps, AGapOfAMinuteIsNoJumpAndABrokenClockTellsNoTimeOfDay) {
  std::vector<LogArtifact> artifacts;
  EXPECT_EQ(split_at_clock_jumps(run_with_jump(55), artifacts).size(), 1u);
  EXPECT_TRUE(artifacts.empty());
  EXPECT_FALSE(split_at_clock_jumps(run_with_jump(1e9), artifacts)[1].start_time_s);
}

TEST(ClockJumps, RowsOfAnUnsteadyClockAreBoundedByTheSamplesOfTheLog) {
  auto run = run_with_jump(0, 400);
  for (std::size_t i = 0; i < run.log.size(); ++i)
    run.log.time_s[i] = 1e-6 * static_cast<double>(i) + 50.0 * static_cast<double>(i / 40);
  const RunSignals signals = make_run_signals(run, 0, Robot{});
  EXPECT_LT(signals.log_period_s * 400 * 100, 10 * 450.0);
  EXPECT_GT(signals.log_period_s, 450.0 / (400 * 100));
}

TEST(ClockJumps, ADatasetWhoseLogJumpsHasOneRunForEachStretch) {
  const std::string folder = JOULEPATH_SOURCE_DIR "/tests/data/broken/";
  const Dataset dataset = dataset_of_log(folder + "dataset/clock_jumps.csv", folder + "good/robot.yaml");
  ASSERT_EQ(dataset.runs.size(), 2u);
  EXPECT_LT(dataset.runs[1].log.time_s.back(), 1e6);
}

}  // namespace
}  // namespace joulepath
