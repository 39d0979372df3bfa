#include "scenarios/log_files/dataset_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <utility>

#include "diagnosis/values/constant_payload.hpp"
#include "model/log_columns.hpp"
#include "scenarios/log_files/run_log.hpp"
#include "tests/scenarios/scratch_directory.hpp"
#include "tests/support/locations.hpp"

namespace joulepath {
namespace {

const std::string kNomadFile = JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml";
const std::string kDatasets = JOULEPATH_SOURCE_DIR "/scenarios/datasets/";
/// Excerpts of measured logs; its README says where they come from.
const std::string kRealLogs = JOULEPATH_SOURCE_DIR "/tests/data/real";

std::string dataset_yaml(const std::string& rest) { return "robot: " + kNomadFile + "\n" + rest; }

const LogArtifact* artifact(const Dataset& dataset, const std::string& kind,
                            const std::string& channel = "") {
  for (const auto& a : dataset.artifacts)
    if (a.kind == kind && (channel.empty() || a.channel == channel)) return &a;
  return nullptr;
}

TEST(DatasetFile, ColumnsMayStandInAnyOrderAndUnknownOnesAreListed) {
  const ScratchDirectory scratch;
  scratch.write("a.csv",
                "note,wheel_speed_right_rad_s,time_s,wheel_speed_left_rad_s\nx,2,0.1,1\ny,2.5,0.2,1.5\n");
  const Dataset dataset = read_dataset(
      scratch.write("d.yaml", dataset_yaml("runs: [{file: a.csv, payload_kg: 5.7, start_time_s: 60}]")));
  ASSERT_EQ(dataset.runs.size(), 1u);
  const auto& run = dataset.runs[0];
  EXPECT_EQ(run.name, "a.csv");
  EXPECT_EQ(run.log.wheel_speed_rad_s.right, (std::vector<double>{2, 2.5}));
  EXPECT_EQ(run.log.wheel_speed_rad_s.left, (std::vector<double>{1, 1.5}));
  EXPECT_TRUE(run.log.payload_kg.empty());  // it does not change
  EXPECT_EQ(constant_payload_kg(run), 5.7);
  EXPECT_EQ(run.start_time_s, 60.0);
  ASSERT_TRUE(artifact(dataset, "ignored_columns"));
  EXPECT_EQ(artifact(dataset, "ignored_columns")->description, "note");
}

TEST(DatasetFile, AnAbsentColumnMayHoldAnything) {
  const ScratchDirectory scratch;
  scratch.write("a.csv",
                "time_s,wheel_speed_left_rad_s,wheel_speed_right_rad_s,motor_current_left_A\n"
                "0,1,1,broken\n1,1,1,sensor\n");
  const std::string whole = dataset_yaml("runs: [{file: a.csv}]\n");
  EXPECT_THROW((void)read_dataset(scratch.write("d.yaml", whole)), ConfigError);
  const std::string absent = whole + "columns: {motor_current_left_A: {absent: true}}\n";
  const Dataset dataset = read_dataset(scratch.write("e.yaml", absent));
  EXPECT_TRUE(dataset.runs.at(0).log.motor_current_A.left.empty());
  EXPECT_EQ(dataset.runs[0].log.wheel_speed_rad_s.left, (std::vector<double>{1, 1}));
}

TEST(DatasetFile, MappingScalesOffsetsSignsAndUnwraps) {
  const ScratchDirectory scratch;
  scratch.write(
      "a.csv", "stamp;velL;velR;curL\r\n65000;0.1;-0.1;1.59\r\n65500;0.1;-0.1;1.59\r\n464;0.1;-0.1;1.59\r\n");
  const Dataset dataset = read_dataset(scratch.write("d.yaml", dataset_yaml(R"(
columns:
  time_s: {from: stamp, scale: 1.0e-3, wraps_at: 65536}
  wheel_speed_left_rad_s: {from: velL, scale: -10}
  wheel_speed_right_rad_s: {from: velR, scale: 10}
  motor_current_left_A: {from: curL, offset: -0.59, unsigned: true}
runs: [{file: a.csv}]
)")));
  const auto& run = dataset.runs[0];
  EXPECT_NEAR(run.log.time_s[2], 66.0, 1e-9);
  EXPECT_NEAR(run.log.wheel_speed_rad_s.left[0], -1.0, 1e-12);
  EXPECT_NEAR(run.log.motor_current_A.left[1], -1.0, 1e-12);  // the wheel turns backward
  EXPECT_TRUE(run.current_sign_from_motion);
  EXPECT_FALSE(run.payload_known);
  EXPECT_TRUE(artifact(dataset, "wrapped"));
  EXPECT_TRUE(artifact(dataset, "unsigned", "motor_current_left_A"));
}

TEST(DatasetFile, APayloadThatContradictsTheLogIsAFinding) {
  const ScratchDirectory scratch;
  scratch.write(
      "a.csv",
      "time_s,wheel_speed_left_rad_s,wheel_speed_right_rad_s,payload_kg\n0,0,0,4\n1,1,1,4\n2,2,2,10\n");
  const auto stated = [&](const std::string& payload) {
    return read_dataset(
        scratch.write("d.yaml", dataset_yaml("\nruns: [{file: a.csv, payload_kg: " + payload + "}]\n")));
  };
  const Dataset contradicts = stated("10"), agrees = stated("[{from_s: 0, kg: 4}, {from_s: 2, kg: 10}]");
  ASSERT_EQ(contradicts.artifacts.size(), 1u);
  EXPECT_EQ(contradicts.artifacts[0].kind, "contradiction");
  EXPECT_EQ(contradicts.artifacts[0].channel, "payload_kg");
  EXPECT_EQ(contradicts.artifacts[0].count, 2u);
  EXPECT_EQ(contradicts.artifacts[0].description,
            "the log has 4 kg, the dataset file 10 kg; the dataset file's value is used");
  EXPECT_EQ(contradicts.runs[0].payload.front().payload_kg, 10);
  EXPECT_TRUE(agrees.artifacts.empty());
}

TEST(DatasetFile, EncoderTicksBecomeSpeeds) {
  const ScratchDirectory scratch;
  scratch.write("a.csv", "time_s,l,r\n0,65534,3\n0.5,0,1\n1.0,2,65535\n");
  const Dataset dataset = read_dataset(scratch.write("d.yaml", dataset_yaml(R"(
columns:
  wheel_speed_left_rad_s: {from: l, scale: 0.25, wraps_at: 65536, derivative: true}
  wheel_speed_right_rad_s: {from: r, scale: 0.25, wraps_at: 65536, derivative: true}
runs: [{file: a.csv}]
)")));
  EXPECT_EQ(dataset.runs[0].log.wheel_speed_rad_s.left, (std::vector<double>{1, 1, 1}));
  EXPECT_EQ(dataset.runs[0].log.wheel_speed_rad_s.right, (std::vector<double>{-1, -1, -1}));
}

TEST(DatasetFile, SeveralFilesAreAlignedByTimeWhereTheyOverlap) {
  const ScratchDirectory scratch;
  scratch.write("odom.csv",
                "time_s,wheel_speed_left_rad_s,wheel_speed_right_rad_s\n0,0,0\n1,1,1\n2,2,2\n3,3,3\n");
  scratch.write("power.csv", "time_s,battery_voltage_V\n0.5,24\n2.5,26\n");
  const Dataset dataset = read_dataset(scratch.write(
      "d.yaml", dataset_yaml("runs: [{files: [odom.csv, power.csv], payload_kg: [{from_s: 0, kg: 0}, "
                             "{from_s: 2, kg: 8.25}], surface: marble, use: validation}]")));
  const auto& run = dataset.runs[0];
  EXPECT_EQ(run.log.time_s, (std::vector<double>{0, 1, 2, 3}));  // a sample stands for its period
  EXPECT_EQ(run.log.battery_voltage_V, (std::vector<double>{24, 24.5, 25.5, 26}));
  EXPECT_EQ(run.log.payload_kg, (std::vector<double>{0, 0, 8.25, 8.25}));
  EXPECT_EQ(run.use, RunUse::validation);
  EXPECT_EQ(run.surface, "marble");
}

/// Rows of a file: its times, and the same value in each of its columns.
std::string file_of(const std::string& columns, double from_s, double to_s, double step_s, double value) {
  std::string text = "time_s," + columns + "\n";
  for (int k = 0; from_s + step_s * k <= to_s + 1e-9; ++k) {
    text += std::to_string(from_s + step_s * k);
    for (auto n = 1 + std::ranges::count(columns, ','); n > 0; --n)
      text += "," + std::to_string(value + 0.01 * k);
    text += "\n";
  }
  return text;
}

/// A channel that is late, early-ending, slow, or in the first file: the drive keeps its length.
TEST(SeveralFiles, NoChannelCutsADrive) {
  const std::string wheels = "wheel_speed_left_rad_s,wheel_speed_right_rad_s",
                    power = "battery_voltage_V,battery_current_A";
  for (const auto& [from_s, to_s, step_s] :
       {std::tuple{12.0, 20.0, 1.0}, std::tuple{0.0, 7.0, 0.1}, std::tuple{5.0, 11.0, 0.5},
        std::tuple{3.0, 18.0, 5.0}, std::tuple{-4.0, 30.0, 1.0}})
    for (const bool first : {false, true}) {
      const ScratchDirectory scratch;
      scratch.write("odom.csv", file_of(wheels, 0, 20, 0.1, 1));
      scratch.write("power.csv", file_of(power, from_s, to_s, step_s, 24));
      const std::string file =
          scratch.write("d.yaml", dataset_yaml(first ? "runs: [{files: [power.csv, odom.csv]}]"
                                                     : "runs: [{files: [odom.csv, power.csv]}]"));
      const std::string named =
          std::to_string(from_s) + " to " + std::to_string(to_s) + (first ? ", first" : "");
      const auto length_s = [](const joulepath::Run& run) {
        return run.log.time_s.back() - run.log.time_s.front();
      };
      const bool whole = from_s - step_s <= 0 && to_s + step_s >= 20;
      const Dataset kept = read_dataset(file, {.keep_whole_drives = true});
      ASSERT_EQ(kept.runs.size(), 1u) << named;
      EXPECT_NEAR(length_s(kept.runs[0]), 20, step_s) << named;
      EXPECT_EQ(kept.runs[0].log.battery_voltage_V.empty(), !whole) << named;
      EXPECT_EQ(artifact(kept, "partial_channel", "battery_voltage_V") != nullptr, !whole) << named;
      const Dataset parts = read_dataset(file);
      double sum_s = 0;
      for (const joulepath::Run& run : parts.runs) {
        sum_s += length_s(run);
        for (const LogColumn& column : log_columns())
          for (const double value : column.of(run.log))
            ASSERT_FALSE(std::isnan(value)) << named << column.name;
      }
      EXPECT_NEAR(sum_s, 20, 0.1 * static_cast<double>(parts.runs.size()) + step_s) << named;
      EXPECT_EQ(std::ranges::count_if(
                    parts.runs, [](const joulepath::Run& run) { return !run.log.battery_voltage_V.empty(); }),
                1)
          << named;
    }
}

/// A log of wheels, and of a battery whose cells are empty outside of a time and in all but each n-th row in
/// it.
std::string log_with_empty_cells(double from_s, double to_s, int each) {
  std::string text = "time_s,wheel_speed_left_rad_s,wheel_speed_right_rad_s,battery_voltage_V,payload_kg\n";
  for (int k = 0; k <= 200; ++k) {
    const bool known = 0.1 * k > from_s - 1e-9 && 0.1 * k < to_s + 1e-9 && k % each == 0;
    text += std::to_string(0.1 * k) + ",1,1," + (known ? std::to_string(24 + 0.001 * k) : "") +
            (k == 100 ? ",8.25\n" : ",\n");
  }
  return text;
}

/// Empty cells at a channel's ends are as unknown as the times before and after a file of its own, in a
/// dataset and in a log alone; between readings they are filled, and a payload holds.
TEST(EmptyCells, AtAChannelsEndsAreNoReadings) {
  for (const auto& [from_s, to_s, each] :
       {std::tuple{12.0, 20.0, 1}, std::tuple{0.0, 7.0, 1}, std::tuple{5.0, 11.0, 5},
        std::tuple{0.0, 20.0, 7}, std::tuple{10.0, 10.0, 1}})
    for (const bool alone : {false, true}) {
      const ScratchDirectory scratch;
      const std::string log = scratch.write("a.csv", log_with_empty_cells(from_s, to_s, each));
      const std::string file = scratch.write("d.yaml", dataset_yaml("runs: [{file: a.csv}]"));
      const std::string robot = read_dataset(file).robot_file,
                        named =
                            std::to_string(from_s) + " to " + std::to_string(to_s) + (alone ? ", alone" : "");
      const auto read = [&](const ReadOptions& options) {
        return alone ? joulepath::dataset_of_log(log, robot, options) : read_dataset(file, options);
      };
      const bool whole = to_s - from_s > 19, some = to_s > from_s;
      const Dataset kept = read({.keep_whole_drives = true}), parts = read({});
      ASSERT_EQ(kept.runs.size(), 1u) << named;
      EXPECT_EQ(kept.runs[0].log.size(), 201u) << named;
      EXPECT_EQ(kept.runs[0].log.battery_voltage_V.empty(), !whole) << named;
      EXPECT_EQ(artifact(kept, "partial_channel", "battery_voltage_V") != nullptr, some && !whole) << named;
      EXPECT_TRUE((some && each == 1) || artifact(kept, "missing_values", "battery_voltage_V")) << named;
      EXPECT_EQ(kept.runs[0].payload.size(), 1u) << named;
      EXPECT_EQ(std::ranges::count_if(
                    parts.runs, [](const joulepath::Run& run) { return !run.log.battery_voltage_V.empty(); }),
                some ? 1 : 0)
          << named;
      for (const joulepath::Run& run : parts.runs)
        for (std::size_t k = 0; k < run.log.battery_voltage_V.size(); ++k)
          EXPECT_NEAR(run.log.battery_voltage_V[k] - run.log.battery_voltage_V[0],
                      0.01 * (run.log.time_s[k] - run.log.time_s[0]), 0.002 * each + 1e-6)
              << named << ": a reading holds for one step at either end";
    }
}

/// Rows without a wheel's speed are no part of the drive, which is said.
TEST(EmptyCells, OfTheMotionCutTheDrive) {
  std::string text = "time_s,wheel_speed_left_rad_s,wheel_speed_right_rad_s\n";
  for (int k = 0; k <= 200; ++k)
    text += std::to_string(0.1 * k) + (k >= 30 ? ",1" : ",") + (k <= 150 ? ",1\n" : ",\n");
  const ScratchDirectory scratch;
  scratch.write("a.csv", text);
  const Dataset dataset = read_dataset(scratch.write("d.yaml", dataset_yaml("runs: [{file: a.csv}]")));
  ASSERT_EQ(dataset.runs.size(), 1u);
  EXPECT_EQ(dataset.runs[0].log.size(), 123u);  // a reading holds for one step at either end
  ASSERT_TRUE(artifact(dataset, "cut"));
  EXPECT_NE(artifact(dataset, "cut")->description.find("2.9 s at the beginning and 4.9 s at the end"),
            std::string::npos)
      << artifact(dataset, "cut")->description;
}

/// Where the motion is not known there is no drive; what is left out is said.
TEST(SeveralFiles, WhatIsCutIsSaid) {
  const ScratchDirectory scratch;
  scratch.write("left.csv", file_of("wheel_speed_left_rad_s", 0, 20, 0.1, 1));
  scratch.write("right.csv", file_of("wheel_speed_right_rad_s", 3, 15, 0.1, 1));
  const Dataset dataset =
      read_dataset(scratch.write("d.yaml", dataset_yaml("runs: [{files: [left.csv, right.csv]}]")));
  ASSERT_EQ(dataset.runs.size(), 1u);
  ASSERT_TRUE(artifact(dataset, "cut"));
  EXPECT_NE(artifact(dataset, "cut")->description.find("2.9 s at the beginning and 4.9 s at the end"),
            std::string::npos)
      << artifact(dataset, "cut")->description;
}

/// A log shorter than any stretch that would stay is kept, without the channel.
TEST(SeveralFiles, AShortLogIsKeptWhole) {
  const ScratchDirectory scratch;
  scratch.write("odom.csv", file_of("wheel_speed_left_rad_s,wheel_speed_right_rad_s", 0, 3, 0.1, 1));
  scratch.write("power.csv", file_of("battery_voltage_V", 1.6, 3, 0.1, 24));
  const Dataset dataset = read_dataset(
      scratch.write("d.yaml", dataset_yaml("runs: [{files: [odom.csv, power.csv], payload_kg: 0}]")));
  ASSERT_EQ(dataset.runs.size(), 1u);
  EXPECT_EQ(dataset.runs[0].log.size(), 31u);
  EXPECT_TRUE(dataset.runs[0].log.battery_voltage_V.empty());
}

TEST(SeveralFiles, AMeasuredEnergyKeepsTheRunWhole) {
  const ScratchDirectory scratch;
  scratch.write("odom.csv", file_of("wheel_speed_left_rad_s,wheel_speed_right_rad_s", 0, 20, 0.1, 1));
  scratch.write("power.csv", file_of("battery_voltage_V", 12, 20, 1, 24));
  const Dataset dataset = read_dataset(scratch.write(
      "d.yaml", dataset_yaml("runs: [{files: [odom.csv, power.csv], battery_energy_Wh: 0.1}]")));
  ASSERT_EQ(dataset.runs.size(), 1u);
  EXPECT_TRUE(dataset.runs[0].log.battery_voltage_V.empty());
  EXPECT_TRUE(artifact(dataset, "partial_channel"));
}

TEST(DatasetFile, WheelSpeedsComeFromBodySpeedsWithTheHalfTrack) {
  const ScratchDirectory scratch;
  scratch.write("a.csv", "time_s,linear_speed_m_s,angular_speed_rad_s\n0,0.5,1\n1,0.5,-1\n");
  const Dataset dataset = read_dataset(scratch.write("d.yaml", dataset_yaml("runs: [{file: a.csv}]")));
  EXPECT_NEAR(dataset.runs[0].log.wheel_speed_rad_s.left[0], (0.5 - 0.165) / 0.1, 1e-12);
  EXPECT_NEAR(dataset.runs[0].log.wheel_speed_rad_s.right[0], (0.5 + 0.165) / 0.1, 1e-12);
}

/// A log of a pose and a column that its user meant as a wheel's speed.
std::string posed_log(const std::string& columns, const std::string& values) {
  std::string csv = "time_s,position_x_m,position_y_m,heading_rad" + columns + "\n";
  for (int i = 0; i < 5; ++i)
    csv += std::to_string(0.1 * i) + "," + std::to_string(0.05 * i) + ",0," + std::to_string(0.2 * i) +
           values + "\n";
  return csv;
}

TEST(DatasetFile, AMistypedColumnIsAnErrorAndNotDerivedFromOthers) {
  const ScratchDirectory scratch;
  for (const std::string wrong : {"wheel_speed_lft_rad_s", "wheel_speed_left_rpm", "wheel_speed_left"}) {
    scratch.write("a.csv", posed_log("," + wrong + ",wheel_speed_right_rad_s", ",5,5"));
    try {
      (void)read_dataset(scratch.write("d.yaml", dataset_yaml("runs: [{file: a.csv}]")));
      FAIL() << wrong;
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.detail().key, wrong);
      EXPECT_NE(error.detail().hint.find("did you mean wheel_speed_left_rad_s?"), std::string::npos)
          << error.what();
    }
  }
  scratch.write("a.csv", posed_log(",wheel_speed_left_rpm,wheel,battery,step", ",5,5,5,5"));
  const Dataset declared = read_dataset(scratch.write(
      "d.yaml", dataset_yaml("columns: {wheel_speed_left_rad_s: {absent: true}}\nruns: [{file: a.csv}]")));
  ASSERT_TRUE(artifact(declared, "ignored_columns"));
  EXPECT_EQ(artifact(declared, "ignored_columns")->description, "wheel_speed_left_rpm, wheel, battery, step");
}

TEST(DatasetFile, OneWheelIsAnErrorAndNoneIsDerivedAndTold) {
  const ScratchDirectory scratch;
  scratch.write("a.csv", posed_log(",wheel_speed_right_rad_s", ",5"));
  const std::string whole = dataset_yaml("runs: [{file: a.csv}]\n");
  try {
    (void)read_dataset(scratch.write("d.yaml", whole));
    FAIL() << "the left wheel is not logged";
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.detail().found, "wheel_speed_right_rad_s without wheel_speed_left_rad_s");
  }
  const Dataset derived =
      read_dataset(scratch.write("e.yaml", whole + "columns: {wheel_speed_right_rad_s: {absent: true}}\n"));
  const Trajectory& log = derived.runs.at(0).log;
  EXPECT_EQ(log.wheel_speed_rad_s.left.size(), log.size());
  EXPECT_NEAR(log.angular_speed_rad_s[2], 2.0, 1e-9);
  for (const char* column :
       {"linear_speed_m_s", "angular_speed_rad_s", "wheel_speed_left_rad_s, wheel_speed_right_rad_s"})
    EXPECT_TRUE(artifact(derived, "derived", column)) << column;
}

TEST(DatasetFile, AMeasuredBodySpeedIsKeptWhereTheOtherIsDerived) {
  const ScratchDirectory scratch;
  scratch.write("a.csv", posed_log(",linear_speed_m_s", ",0.75"));
  const Dataset dataset = read_dataset(scratch.write("d.yaml", dataset_yaml("runs: [{file: a.csv}]")));
  EXPECT_EQ(dataset.runs.at(0).log.linear_speed_m_s, std::vector<double>(5, 0.75));
  EXPECT_FALSE(artifact(dataset, "derived", "linear_speed_m_s"));
  EXPECT_TRUE(artifact(dataset, "derived", "angular_speed_rad_s"));
}

TEST(DatasetFile, TheMappingOfAHeadingAppliesToQuaternions) {
  const ScratchDirectory scratch;
  scratch.write("a.csv",
                "time_s,wheel_speed_left_rad_s,wheel_speed_right_rad_s,orientation_w,orientation_z\n"
                "0,1,1,1,0\n1,1,1,0.8,0.6\n");
  const auto heading_rad = [&](const std::string& mapping) {
    return read_dataset(scratch.write("d.yaml", dataset_yaml("columns: {heading_rad: {" + mapping +
                                                             "}}\nruns: [{file: a.csv}]")))
        .runs.at(0)
        .log.heading_rad;
  };
  EXPECT_NEAR(heading_rad("scale: -1, offset: 0.5").at(1), 0.5 - 2 * std::atan2(0.6, 0.8), 1e-12);
  EXPECT_TRUE(heading_rad("absent: true").empty());
}

TEST(DatasetFile, QuaternionPosesGiveHeadingInAllQuadrantsAndSpeed) {
  const ScratchDirectory scratch;
  std::string csv =
      "time_s,position_x_m,position_y_m,orientation_w,orientation_x,orientation_y,orientation_z\n";
  for (int i = 0; i <= 100; ++i) {  // a circle of radius 2 at 0.5 m/s, more than once around
    const double t = 0.3 * i, yaw = 0.25 * t;
    csv += std::to_string(t) + "," + std::to_string(2 * std::sin(yaw)) + "," +
           std::to_string(2 - 2 * std::cos(yaw)) + "," + std::to_string(std::cos(yaw / 2)) + ",0,0," +
           std::to_string(std::sin(yaw / 2)) + "\n";
  }
  scratch.write("a.csv", csv);
  const Dataset dataset = read_dataset(scratch.write("d.yaml", dataset_yaml("runs: [{file: a.csv}]")));
  const Trajectory& log = dataset.runs[0].log;
  EXPECT_NEAR(log.heading_rad.back(), 7.5, 1e-5);
  for (std::size_t i = 0; i < log.size(); ++i) {
    EXPECT_NEAR(log.linear_speed_m_s[i], 0.5, 1e-3) << i;
    EXPECT_NEAR(log.angular_speed_rad_s[i], 0.25, 1e-4) << i;
  }
}

TEST(DatasetFile, EnergyOnlyRunKeepsItsMotion) {
  const ScratchDirectory scratch;
  const Dataset dataset = read_dataset(scratch.write(
      "d.yaml",
      dataset_yaml("runs: [{motion: {profile: constant_ramp, acceleration_m_s2: 0.2, ramp_s: 4, distance_m: "
                   "10}, payload_kg: 8.25, measured_energy_J: {left: 74.66, right: 70.17}}]")));
  const auto& run = dataset.runs[0];
  EXPECT_EQ(run.log.size(), 0u);
  ASSERT_TRUE(run.motion);
  EXPECT_EQ(run.motion->profile, MotionProfile::constant_ramp);
  EXPECT_EQ(run.motion->ramp_s, 4.0);
  EXPECT_EQ(run.measured_energy_J->right, 70.17);
  EXPECT_EQ(run.payload.front().payload_kg, 8.25);
}

/// A run's log with a gyro and the log of a simulator with this text, under a dataset file.
std::string dataset_with_simulator(const ScratchDirectory& scratch, const std::string& simulator) {
  scratch.write("a.csv", "t,l,r,gyro_yaw_rate_rad_s\n0,0,0,0\n1,1,1,0\n");
  scratch.write("sim.csv", simulator);
  return scratch.write("d.yaml", dataset_yaml(R"(
columns: {time_s: {from: t}, wheel_speed_left_rad_s: {from: l}, wheel_speed_right_rad_s: {from: r}}
runs: [{file: a.csv, predicted: sim.csv}]
)"));
}

const std::string kSimulatorColumns = "time_s,wheel_speed_left_rad_s,wheel_speed_right_rad_s";

TEST(DatasetFile, PredictionOfAnotherSimulatorIsRead) {
  const ScratchDirectory scratch;
  const Dataset dataset = read_dataset(dataset_with_simulator(
      scratch, kSimulatorColumns + ",gyro_yaw_rate_rad_s\n0,7,7,0\n0.5,8,8,0\n1,9,9,0\n"));
  ASSERT_TRUE(dataset.runs[0].predicted);
  EXPECT_EQ(dataset.runs[0].predicted->wheel_speed_rad_s.left[1], 8.0);
}

TEST(DatasetFile, PredictionOfAnotherTimeOrOfNoCommonChannelIsRefused) {
  const ScratchDirectory scratch;
  const auto refused = [&](const std::string& simulator) {
    try {
      static_cast<void>(read_dataset(dataset_with_simulator(scratch, simulator)));
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string late =
      refused(kSimulatorColumns + ",gyro_yaw_rate_rad_s\n20,7,7,0\n20.5,8,8,0\n21,9,9,0\n");
  EXPECT_NE(late.find("d.yaml:"), std::string::npos) << late;
  EXPECT_NE(late.find("runs[0].predicted: found a log from 20 to 21 s"), std::string::npos) << late;
  const std::string bare = refused(kSimulatorColumns + "\n0,7,7\n0.5,8,8\n1,9,9\n");
  EXPECT_NE(bare.find("runs[0].predicted: found no channel beyond the motion"), std::string::npos) << bare;
}

TEST(DatasetFile, RoughLogsAreReadAndTheirArtifactsReported) {
  const ScratchDirectory scratch;
  std::string csv = "time_s,wheel_speed_left_rad_s,wheel_speed_right_rad_s,battery_voltage_V\n";
  double t = 0.0;
  for (int i = 0; i < 200; ++i) {
    t += i == 100 ? 2.0 : 0.02;
    const double left = i >= 120 && i < 160 ? 5.0 : 4.0 + std::sin(0.37 * i);
    csv += std::to_string(t) + "," + std::to_string(left) + "," + std::to_string(4.0 + std::cos(0.41 * i)) +
           "," + (i % 7 == 3 ? "" : std::to_string(24.0 + std::sin(1.7 * i))) + "\n";
  }
  scratch.write("a.csv", csv);
  const Dataset dataset = read_dataset(scratch.write("d.yaml", dataset_yaml("runs: [{file: a.csv}]")));
  ASSERT_TRUE(artifact(dataset, "clock_jump"));
  EXPECT_NEAR(artifact(dataset, "clock_jump")->first_time_s, 2.0, 1e-9);
  ASSERT_TRUE(artifact(dataset, "held_value", "wheel_speed_left_rad_s"));
  EXPECT_FALSE(artifact(dataset, "held_value", "wheel_speed_right_rad_s"));
  ASSERT_TRUE(artifact(dataset, "missing_values", "battery_voltage_V"));
  EXPECT_EQ(artifact(dataset, "missing_values", "battery_voltage_V")->count, 29u);
  EXPECT_EQ(artifact(dataset, "missing_values", "battery_voltage_V")->description,
            "15 % of the rows are empty, filled by interpolation");
  for (const double v : dataset.runs[0].log.battery_voltage_V) EXPECT_TRUE(std::isfinite(v));
}

/// A battery's current at 10 Hz in steps of 5 mA, at rest and in motion, beside wheels at 50 Hz; as empty
/// cells or as a second file, from 0.5 s on, on two clocks: the rows between its readings are the reader's. A
/// sensor that stops is still found.
TEST(DatasetFile, WhatFillsTheRowsBetweenReadingsIsNoHeldValue) {
  const auto artifacts_of = [](bool second_file, double start_s, double step_A, bool stops) {
    const ScratchDirectory scratch;
    std::string wheels = "time_s,wheel_speed_left_rad_s,wheel_speed_right_rad_s",
                battery = "time_s,battery_current_A\n";
    wheels += second_file ? "\n" : ",battery_current_A\n";
    for (int i = 0; i <= 1500; ++i) {
      const std::string time = std::to_string(start_s + 0.02 * i + 0.004 * std::sin(2.3 * i));
      wheels +=
          time + "," + std::to_string(4 + std::sin(0.37 * i)) + "," + std::to_string(4 + std::cos(0.41 * i));
      const int held = stops && i > 600 && i < 800 ? 600 : i;
      const double amperes =
          i < 300 && !stops ? 0.4 : 1.2 + 0.7 * std::sin(0.013 * held) + 0.1 * std::sin(1.9 * held);
      const std::string reading =
          i % 5 == 0 && i >= 25 ? std::to_string(step_A * std::round(amperes / step_A)) : "";
      if (second_file && !reading.empty()) battery += time + "," + reading + "\n";
      wheels += second_file ? "\n" : "," + reading + "\n";
    }
    scratch.write("a.csv", wheels), scratch.write("b.csv", battery);
    const std::string runs = second_file ? "runs: [{files: [a.csv, b.csv]}]" : "runs: [{file: a.csv}]";
    return read_dataset(scratch.write("d.yaml", dataset_yaml(runs)));
  };
  for (const bool second_file : {false, true})
    for (const double start_s : {0.0, 1.7e9}) {
      const Dataset sound = artifacts_of(second_file, start_s, 5e-3, false),
                    stopped = artifacts_of(second_file, start_s, 1e-5, true);
      EXPECT_FALSE(artifact(sound, "held_value")) << second_file;
      EXPECT_FALSE(artifact(sound, "slow_channel")) << second_file;
      ASSERT_TRUE(artifact(stopped, "held_value", "battery_current_A")) << second_file;
      EXPECT_NEAR(artifact(stopped, "held_value")->first_time_s, 12.0, 0.51) << "since the log's first row";
      EXPECT_EQ(artifact(stopped, "held_value")->count, 40u) << "readings, not rows";
    }
}

TEST(DatasetFile, ASlowLocalizationIsReportedAndASmoothDriveIsNot) {
  const ScratchDirectory scratch;
  const auto artifacts_with_pose_every = [&](int rows) {
    std::string csv =
        "time_s,wheel_speed_left_rad_s,wheel_speed_right_rad_s,position_x_m,position_y_m,heading_rad\n";
    for (int i = 0; i < 400; ++i) {  // noise-free: stand, accelerate, cruise along x
      const double t = 0.02 * i, speed = i < 50 ? 0.0 : std::min(0.05 * (i - 50), 5.0);
      const double x = i / rows * rows < 50 ? 0.0 : 0.001 * (i / rows * rows - 50);
      csv += std::to_string(t) + "," + std::to_string(speed) + "," + std::to_string(1.001 * speed) + "," +
             std::to_string(x) + ",0.5,0.25\n";
    }
    scratch.write("a.csv", csv);
    return read_dataset(scratch.write("d.yaml", dataset_yaml("runs: [{file: a.csv, payload_kg: 0}]")))
        .artifacts;
  };
  EXPECT_TRUE(artifacts_with_pose_every(1).empty());
  const auto slow = artifacts_with_pose_every(5);
  ASSERT_EQ(slow.size(), 1u);
  EXPECT_EQ(slow[0].kind, "slow_channel");
  EXPECT_EQ(slow[0].channel, "position_x_m");
}

TEST(DatasetFile, WrittenLogReadsBackToTheLastBit) {
  Trajectory log;
  for (int i = 0; i < 50; ++i) {
    log.time_s.push_back(i / 3.0);
    log.wheel_speed_rad_s.left.push_back(std::sin(i));
    log.wheel_speed_rad_s.right.push_back(-1e-17 * i);
    log.heading_rad.push_back(std::exp(0.1 * i));
    log.payload_kg.push_back(i > 20 ? 5.7 : 0.0);
    log.energy_J.push_back(i);
  }
  const ScratchDirectory scratch;
  const RunLog again = read_run_log(scratch.write("log.csv", run_log_text(log)), Geometry{});
  EXPECT_EQ(again.trajectory.time_s, log.time_s);
  EXPECT_EQ(again.trajectory.wheel_speed_rad_s, log.wheel_speed_rad_s);
  EXPECT_EQ(again.trajectory.heading_rad, log.heading_rad);
  EXPECT_EQ(again.trajectory.payload_kg, log.payload_kg);
}

TEST(DatasetFile, PracticeSetsReadWithoutArtifactsOfTheirOwn) {
  std::size_t sets = 0;
  for (const auto& entry : std::filesystem::directory_iterator(JOULEPATH_SOURCE_DIR "/tests/data/practice")) {
    if (!entry.is_directory()) continue;
    ++sets;
    const Dataset dataset = read_dataset((entry.path() / "dataset.yaml").string());
    EXPECT_GE(dataset.runs.size(), 12u);
    for (const auto& a : dataset.artifacts)
      ADD_FAILURE() << entry.path() << " " << a.run << " " << a.kind << " " << a.channel << " "
                    << a.description;
    for (const auto& run : dataset.runs) {
      EXPECT_GT(run.log.size(), 70u);  // 7 s at 10 Hz
      EXPECT_EQ(run.log.motor_current_A.left.size(), run.log.size());
    }
  }
  EXPECT_EQ(sets, 14u);
}

/// Steps of the clock and speeds of the wheels stay within bounds: what wraps is unwrapped.
void expect_continuous(const Run& run, double least_step_s, double largest_step_s, double largest_rad_s) {
  const Trajectory& log = run.log;
  ASSERT_GT(log.size(), 50u) << run.name;
  for (std::size_t i = 1; i < log.size(); ++i) {
    const double step_s = log.time_s[i] - log.time_s[i - 1];
    ASSERT_TRUE(step_s > least_step_s && step_s < largest_step_s) << run.name << " row " << i;
    for (Side side : kSides)
      ASSERT_LT(std::abs(log.wheel_speed_rad_s[side][i]), largest_rad_s) << run.name << " row " << i;
  }
}

TEST(DatasetFile, RealKobukiLogsReadOnWhereClockAndCountersWrap) {
  ASSERT_EQ(setenv("JOULEPATH_DATA_DIR", kRealLogs.c_str(), 1), 0);
  const Dataset kobuki = read_dataset(kDatasets + "kobuki_wheelslip.yaml");
  ASSERT_EQ(kobuki.runs.size(), 5u);
  for (const auto& run : kobuki.runs) expect_continuous(run, 0.019, 0.061, 40.0);
}

/// A dataset file's text with the runs whose logs the excerpt has, and how many it lists.
std::pair<std::string, int> with_runs_of_the_excerpt(const std::string& file) {
  const std::string variable = "${JOULEPATH_DATA_DIR}";
  std::ifstream in(file);
  std::pair<std::string, int> kept;
  for (std::string line; std::getline(in, line);) {
    if (const std::size_t at = line.find(variable); at != std::string::npos) {
      ++kept.second;
      const std::size_t from = at + variable.size();
      if (!std::filesystem::exists(kRealLogs + line.substr(from, line.find('"', from) - from))) continue;
    }
    kept.first += line + "\n";
  }
  return kept;
}

TEST(DatasetFile, RealHuskyLogsReadOnEachTerrain) {
  ASSERT_EQ(setenv("JOULEPATH_DATA_DIR", kRealLogs.c_str(), 1), 0);
  auto [text, listed] = with_runs_of_the_excerpt(kDatasets + "husky_borealtc.yaml");
  EXPECT_EQ(listed, 71);
  text.replace(text.find("../robots"), 2, JOULEPATH_SOURCE_DIR "/scenarios");
  const ScratchDirectory scratch;
  const Dataset husky = read_dataset(scratch.write("d.yaml", text));
  std::set<std::string> terrains;
  for (const auto& run : husky.runs) {
    terrains.insert(run.surface);
    expect_continuous(run, 0.15, 0.16, 1.0 / 0.13);  // 6.5 Hz; the robot's top speed is 1 m/s
    EXPECT_TRUE(run.current_sign_from_motion);
  }
  EXPECT_EQ(terrains, (std::set<std::string>{"asphalt", "flooring", "ice", "sandy_loam", "snow"}));
}

}  // namespace
}  // namespace joulepath
