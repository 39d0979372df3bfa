#include "extensions/bags/bag_export.hpp"

#include <gtest/gtest.h>

#include "extensions/bags/bag_survey.hpp"
#include "planner/path/geometry/path.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "scenarios/log_files/run_log.hpp"
#include "tests/scenarios/export/continuous_plans.hpp"
#include "tests/scenarios/export/lopsided_plan.hpp"
#include "tests/scenarios/scratch_directory.hpp"

namespace joulepath::testing {
namespace {

TEST(ExportLaws, ABagReadsBackAsThePlanAtEverySample) {
  const ScratchDirectory scratch;
  const std::string file =
      scratch.write("plan.mcap", export_bag(lopsided_plan().input("b.mcap")).files.at(0).content);
  ColumnSources sources;
  const std::vector<std::pair<std::string, std::string>> topics{
      {"linear_speed_m_s", "/plan/odom.twist.twist.linear.x"},
      {"angular_speed_rad_s", "/plan/odom.twist.twist.angular.z"},
      {"position_x_m", "/plan/odom.pose.pose.position.x"},
      {"position_y_m", "/plan/odom.pose.pose.position.y"},
      {"motor_power_left_W", "/plan/power.motor_power_left_W"},
      {"motor_power_right_W", "/plan/power.motor_power_right_W"},
      {"motor_current_left_A", "/plan/power.motor_current_left_A"},
      {"motor_current_right_A", "/plan/power.motor_current_right_A"}};
  for (const auto& [column, topic] : topics) sources[column].from = {topic};
  const Trajectory back =
      read_run_log({{file, {}}}, sources, lopsided_plan().world.robot.geometry, "run").trajectory;
  const Trajectory alone =
      read_run_log(file, lopsided_plan().world.robot.geometry).trajectory;  // heading from the orientation
  ASSERT_EQ(back.size(), lopsided_rows().size());
  ASSERT_EQ(alone.size(), lopsided_rows().size());
  for (std::size_t k = 0; k < back.size(); ++k) {
    ASSERT_NEAR(back.time_s[k], lopsided_rows().time_s[k], 1e-8) << k;
    ASSERT_NEAR(back.linear_speed_m_s[k], lopsided_rows().linear_speed_m_s[k], 1e-9) << k;
    ASSERT_NEAR(back.angular_speed_rad_s[k], lopsided_rows().angular_speed_rad_s[k], 1e-9) << k;
    ASSERT_NEAR(back.position_x_m[k], lopsided_rows().position_x_m[k], 1e-9) << k;
    ASSERT_NEAR(back.position_y_m[k], lopsided_rows().position_y_m[k], 1e-9) << k;
    ASSERT_NEAR(wrapped_angle_rad(alone.heading_rad[k] - lopsided_rows().heading_rad[k]), 0, 1e-9) << k;
    for (const Side side : kSides) {
      ASSERT_NEAR(back.motor_power_W[side][k], lopsided_rows().motor_power_W[side][k], 1e-9) << k;
      ASSERT_NEAR(back.motor_current_A[side][k], lopsided_rows().motor_current_A[side][k], 1e-9) << k;
    }
  }
}

/// What is proposed for the program's own bag is a dataset.
TEST(ExportLaws, TheDatasetProposedForABagReadsIt) {
  const ScratchDirectory scratch;
  const std::string file =
      scratch.write("plan.mcap", export_bag(lopsided_plan().input("b.mcap")).files.at(0).content);
  const Robot& robot = lopsided_plan().world.robot;
  const std::string dataset = scratch.write("dataset.yaml", suggested_dataset(survey_bag(file), file));
  const Trajectory log = dataset_from(Document::load(dataset), {}, {}, {.robot = &robot}).runs.at(0).log;
  EXPECT_EQ(log.size(), lopsided_rows().size());
  EXPECT_EQ(log.motor_power_W.left.size(), log.size());
  ASSERT_EQ(log.payload_kg.size(), log.size()) << "estimated without its payload it takes less";
  for (std::size_t k = 0; k < log.size(); ++k)
    ASSERT_NEAR(log.payload_kg[k], lopsided_rows().payload_kg[k], 1e-9) << k;
}

TEST(ContinuousPlan, RowsOfABagFollowEachOther) {
  const ScratchDirectory scratch;
  for (const PlannedMission& plan : continuous_plans()) {
    const std::string bag = scratch.write("plan.mcap", export_bag(plan.input("x.json")).files[0].content);
    expect_continuous(rows_of(read_run_log(bag, plan.world.robot.geometry).trajectory), plan.plan.duration_s,
                      plan.name + ", bag");
  }
}

}  // namespace
}  // namespace joulepath::testing
