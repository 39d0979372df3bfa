#pragma once

#include <array>
#include <string_view>

#include "model/robot.hpp"

namespace joulepath {

/// A key of `limits:` and the field that it fills.
struct LimitKey {
  std::string_view name{};
  double Limits::*field{};
  std::string_view says{};
};

inline constexpr std::array kLimitKeys{
    LimitKey{"speed_m_s", &Limits::speed_m_s, "greatest speed"},
    LimitKey{"acceleration_m_s2", &Limits::acceleration_m_s2, "greatest gain of speed"},
    LimitKey{"deceleration_m_s2", &Limits::deceleration_m_s2, "greatest loss of speed"},
    LimitKey{"lateral_acceleration_m_s2", &Limits::lateral_acceleration_m_s2,
             "speed squared times curvature"},
    LimitKey{"yaw_rate_rad_s", &Limits::yaw_rate_rad_s, "greatest turning rate"},
    LimitKey{"yaw_acceleration_rad_s2", &Limits::yaw_acceleration_rad_s2, "greatest change of turning rate"},
    LimitKey{"wheel_acceleration_rad_s2", &Limits::wheel_acceleration_rad_s2, "of each wheel"},
    LimitKey{"jerk_m_s3", &Limits::jerk_m_s3, "greatest change of acceleration"},
    LimitKey{"traction_coefficient", &Limits::traction_coefficient, "wheel force over normal load"},
    LimitKey{"motor_power_W", &Limits::motor_power_W, "electrical, per motor"},
    LimitKey{"battery_power_W", &Limits::battery_power_W, "at the battery's terminals, standby included"},
    LimitKey{"max_payload_kg", &Limits::max_payload_kg, "greatest payload"},
};

}  // namespace joulepath
