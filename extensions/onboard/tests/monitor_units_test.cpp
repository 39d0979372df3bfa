#include <gtest/gtest.h>

#include <algorithm>

#include "diagnosis/checks/data_checks.hpp"
#include "diagnosis/checks/faults.hpp"
#include "extensions/onboard/tests/drives_in_units.hpp"

namespace joulepath {
namespace {

using testing::kShippedRobots;
using testing::kUnitSlips;
using testing::sound_drive;
using testing::SoundDrive;
using testing::UnitSlip;

std::vector<MonitorRow> rows_of(const SoundDrive& drive, const UnitSlip& slip = {"", 1}) {
  std::vector<MonitorRow> rows;
  for (std::size_t k = 0; k < drive.log.size(); ++k)
    rows.push_back(monitor_row(drive.log, k)), slip.spoil(rows.back());
  return rows;
}

bool has_channel(const SoundDrive& drive, const UnitSlip& slip) {
  const std::string name = slip.channel;
  if (name == "heading_rad") return !drive.log.heading_rad.empty();
  if (name.starts_with("battery_")) return !drive.log.battery_current_A.empty();
  return true;
}

/// The channels that rows have.
Trajectory log_of(const std::vector<MonitorRow>& rows) {
  Trajectory log;
  for (const MonitorRow& row : rows) append_row(row, row.payload_kg, log);
  return log;
}

/// What the monitor says of rows: empty where it believes them.
std::string refusal(const SoundDrive& drive, const std::vector<MonitorRow>& rows) {
  Monitor monitor(drive.robot, drive.course, {});
  for (const MonitorRow& row : rows) {
    (void)monitor.add(row);
    if (monitor.implausible()) break;
  }
  if (const std::optional<Implausible>& odd = monitor.judge_end()) return odd->channel + ": " + odd->found;
  return monitor.status().rows.used > rows.size() / 2 ? "" : "rows that are late or broken";
}

/// What `check` says of the whole log.
std::vector<DataCheck> checks_of(const SoundDrive& drive, const Trajectory& log) {
  Dataset dataset{.robot = drive.robot, .runs = {{.name = "log", .log = log, .payload_known = true}}};
  dataset.runs.front().payload = {{log.time_s.front(), 1.0}};
  return check_data(dataset, sort_runs(dataset));
}

TEST(MonitorUnits, SoundLogsOfAllShippedRobotsAreBelieved) {
  for (const char* robot : kShippedRobots)
    for (const double rate_Hz : {20.0, 50.0, 200.0, 1000.0}) {
      const SoundDrive drive = sound_drive(robot, rate_Hz);
      EXPECT_TRUE(checks_of(drive, drive.log).empty()) << robot << " at " << rate_Hz << " Hz";
      EXPECT_EQ(refusal(drive, rows_of(drive)), "") << robot << " at " << rate_Hz << " Hz";
    }
}

// At 1 kHz two robots alone: a row takes 45 us.
TEST(MonitorUnits, AnotherUnitIsNotBelieved) {
  for (const std::string robot : kShippedRobots)
    for (const double rate_Hz : {20.0, 1000.0}) {
      if (rate_Hz > 20 && robot != "nomad_super_scout" && robot != "tug_600kg") continue;
      const SoundDrive drive = sound_drive(robot, rate_Hz, 2);
      for (const UnitSlip& slip : kUnitSlips) {
        if (!has_channel(drive, slip)) continue;
        EXPECT_FALSE(refusal(drive, rows_of(drive, slip)).empty())
            << robot << " at " << rate_Hz << " Hz: " << slip.channel << " times " << slip.factor;
      }
    }
}

/// Speeds in a larger unit than the column's look like a robot at rest.
TEST(MonitorUnits, WheelsThatSeemToStandAreNotBelieved) {
  const SoundDrive drive = sound_drive("nomad_super_scout", 50, 4);
  for (const double factor : {1 / testing::kDegrees, 0.02})
    EXPECT_FALSE(refusal(drive, rows_of(drive, {"wheel_speed", factor})).empty()) << factor;
}

/// Swapped, inverted and scaled channels that the monitor reads, too.
TEST(MonitorUnits, WhatTheChecksOfAFileSuspectIsNotBelieved) {
  int suspect = 0;
  for (const char* robot : {"nomad_super_scout", "tug_600kg"}) {
    const SoundDrive sound = sound_drive(robot, 50, 3);
    const Trajectory read = log_of(rows_of(sound));
    const joulepath::Run run{.name = "log", .log = read, .payload_known = true};
    const std::vector<Fault> faults = possible_faults(run);
    for (std::size_t f = std::string(robot).size() % 3; f < faults.size(); f += 8) {
      SoundDrive spoilt = sound;
      spoilt.log = repaired(run, faults[f].columns, sound.robot.geometry).log;
      const std::vector<DataCheck> checks = checks_of(spoilt, spoilt.log);
      if (checks.empty()) continue;
      ++suspect;
      EXPECT_FALSE(refusal(spoilt, rows_of(spoilt)).empty())
          << robot << ": " << faults[f].kind << ' ' << faults[f].channel << ", where the file has "
          << checks.front().channel << ": " << checks.front().evidence;
    }
  }
  EXPECT_GT(suspect, 8);
}

}  // namespace
}  // namespace joulepath
