#include <gtest/gtest.h>

#include <algorithm>

#include "diagnosis/checks/data_checks.hpp"
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

/// What the monitor says of rows: empty where it believes them.
std::string refusal(const SoundDrive& drive, const std::vector<MonitorRow>& rows) {
  Monitor monitor(drive.robot, drive.course, {});
  for (const MonitorRow& row : rows) {
    (void)monitor.add(row);
    if (monitor.implausible()) return monitor.implausible()->channel + ": " + monitor.implausible()->found;
  }
  return monitor.status().rows.used > rows.size() / 2 ? "" : "rows that are late or broken";
}

TEST(MonitorUnits, SoundLogsOfAllShippedRobotsAreBelieved) {
  for (const char* robot : kShippedRobots)
    for (const double rate_Hz : {20.0, 50.0, 200.0, 1000.0}) {
      const SoundDrive drive = sound_drive(robot, rate_Hz);
      EXPECT_EQ(refusal(drive, rows_of(drive)), "") << robot << " at " << rate_Hz << " Hz";
    }
}

TEST(MonitorUnits, AnotherUnitIsNotBelieved) {
  for (const char* robot : kShippedRobots)
    for (const double rate_Hz : {20.0, 1000.0}) {
      const SoundDrive drive = sound_drive(robot, rate_Hz, 2);
      for (const UnitSlip& slip : kUnitSlips) {
        if (!has_channel(drive, slip)) continue;
        EXPECT_FALSE(refusal(drive, rows_of(drive, slip)).empty())
            << robot << " at " << rate_Hz << " Hz: " << slip.channel << " times " << slip.factor;
      }
    }
}

}  // namespace
}  // namespace joulepath
