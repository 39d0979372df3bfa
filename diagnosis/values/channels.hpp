#pragma once

#include <array>
#include <string_view>

namespace joulepath {

/// Compared channels, one column each: the structured rows of diagnosis.md. A current row is mechanics (i -
/// tau/(Kt n)). A winding row is V - R i - Kv n q' with the measured current. The driver row is battery power
/// minus motor power (the whole battery power where the motors are not measured). The supply row is the
/// battery's voltage under its current. The others compare motion with wheel travel.
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
