#pragma once

#include <array>
#include <string_view>

namespace joulepath {

/// What the diagnosis compares, one column each. The structured rows of diagnosis.md: currents are
/// mechanics (i - tau/(Kt n)); a winding row is V - R i - Kv n q' with the measured current; the
/// driver row is battery power less what the motors take (all of it where nothing measures the motors); the
/// supply row is the battery's voltage under its current; the rest is motion against wheel travel.
enum Channel {
  kCurrentLeft,
  kCurrentRight,
  kWindingLeft,
  kWindingRight,
  kDriverPower,
  kSupplyVoltage,
  kGyro,
  kHeading,
  kPositionX,
  kPositionY,
  kChannelCount
};

inline constexpr std::array<std::string_view, kChannelCount> kChannelNames{
    "current_left",    "current_right", "voltage_left", "voltage_right", "battery_power",
    "battery_voltage", "gyro",          "heading",      "position_x",    "position_y"};

}  // namespace joulepath
