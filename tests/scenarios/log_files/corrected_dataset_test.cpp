#include "scenarios/log_files/corrected_dataset.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "scenarios/log_files/dataset_file.hpp"
#include "tests/scenarios/scratch_directory.hpp"
#include "tests/support/practice_sets.hpp"

namespace joulepath {
namespace {

const std::string kColumns = R"(
columns:
  time_s: {from: stamp, scale: 1.0e-3}
  wheel_speed_left_rad_s: {from: [velL, vel_left], scale: 10}
  wheel_speed_right_rad_s: {from: velR, scale: 10}
  motor_current_left_A: {from: curL, scale: 0.01, offset: -0.59}
  motor_voltage_left_V: {from: volL, delay_s: 0.02}
)";

/// A log with its own names and units.
std::string log_text() {
  std::string text = "stamp,velL,velR,curL,volL,motor_current_right_A\n";
  for (int i = 0; i < 100; ++i)
    text += std::to_string(20 * i) + "," + std::to_string(0.5 + 0.001 * i) + ",0.5," +
            std::to_string(100 + i % 7) + "," + std::to_string(5 + 0.01 * i) + "," +
            std::to_string(1 + 0.001 * i) + "\n";
  return text;
}

class CorrectedDataset : public ::testing::Test {
 protected:
  /// The dataset read, written corrected into another folder, and read again.
  Dataset round_trip(const std::vector<EffectSetting>& instruments) {
    scratch_.write("logs/a.csv", log_text());
    const std::string file = scratch_.write(
        "dataset.yaml",
        "robot: " JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml" + kColumns +
            "runs:\n  - {file: logs/a.csv, payload_kg: 5.7, start_time_s: 60, surface: marble, "
            "use: validation}\n");
    before_ = read_dataset(file);
    const std::string text = corrected_dataset_text(before_, instruments, scratch_.at("out/diagnosis"));
    return read_dataset(scratch_.write("out/diagnosis/dataset_corrected.yaml", text));
  }

  ScratchDirectory scratch_{};
  Dataset before_{};
};

TEST_F(CorrectedDataset, WithNothingToCorrectReadsTheSame) {
  const Dataset after = round_trip({});
  const auto &a = before_.runs[0], &b = after.runs[0];
  EXPECT_EQ(a.log.time_s, b.log.time_s);
  EXPECT_EQ(a.log.wheel_speed_rad_s.left, b.log.wheel_speed_rad_s.left);
  EXPECT_EQ(a.log.motor_current_A.left, b.log.motor_current_A.left);
  EXPECT_EQ(a.log.motor_voltage_V.left, b.log.motor_voltage_V.left);
  EXPECT_EQ(a.log.payload_kg, b.log.payload_kg);
  EXPECT_EQ(a.surface, b.surface);
  EXPECT_EQ(a.use, b.use);
  EXPECT_EQ(a.start_time_s, b.start_time_s);
}

TEST_F(CorrectedDataset, UndoesOffsetAndGainOnTopOfTheFilesOwnMapping) {
  const Dataset after =
      round_trip({{.name = "current_sensor_offset", .parameters = {{"offset_A", 0.05}}, .side = Side::left},
                  {.name = "current_sensor_gain", .parameters = {{"fraction", 0.25}}}});
  for (std::size_t i = 0; i < before_.runs[0].log.size(); ++i) {
    EXPECT_NEAR(after.runs[0].log.motor_current_A.left[i],
                (before_.runs[0].log.motor_current_A.left[i] - 0.05) / 1.25, 1e-12);
    EXPECT_NEAR(after.runs[0].log.motor_current_A.right[i],
                before_.runs[0].log.motor_current_A.right[i] / 1.25, 1e-12);
  }
  EXPECT_EQ(after.runs[0].log.motor_voltage_V.left, before_.runs[0].log.motor_voltage_V.left);
}

TEST_F(CorrectedDataset, AddsTheDelayToOneThatTheFileHas) {
  const Dataset after = round_trip({{.name = "time_misalignment", .parameters = {{"delay_s", 0.1}}}});
  const Trajectory &a = before_.runs[0].log, &b = after.runs[0].log;
  for (std::size_t i = 10; i + 10 < a.size(); ++i) {  // 0.1 s are five samples
    EXPECT_NEAR(b.motor_voltage_V.left[i], a.motor_voltage_V.left[i + 5], 1e-9);
    EXPECT_NEAR(b.motor_current_A.right[i], a.motor_current_A.right[i + 5], 1e-9);
    EXPECT_NEAR(b.wheel_speed_rad_s.left[i], a.wheel_speed_rad_s.left[i], 1e-12);
  }
}

TEST(CorrectedPracticeSet, NoLongerHasTheInstrumentsError) {
  const Dataset dataset = read_dataset(testing::practice_file("p12_two_effects_rough"));
  const Diagnosis first = diagnose(dataset, {.bootstrap = 20});
  ASSERT_FALSE(first.corrected_instruments.empty());
  const ScratchDirectory scratch;
  const std::string text = corrected_dataset_text(dataset, first.corrected_instruments, scratch.at("out"));
  const Diagnosis second =
      diagnose(read_dataset(scratch.write("out/dataset_corrected.yaml", text)), {.bootstrap = 20});
  for (const Cause& cause : second.causes)
    for (const EffectSetting& instrument : first.corrected_instruments)
      EXPECT_NE(cause.effect.name, instrument.name);
  EXPECT_EQ(second.causes.size() + first.corrected_instruments.size(), first.causes.size());
}

}  // namespace
}  // namespace joulepath
