#pragma once

#include "planner/values/profile_request.hpp"

namespace joulepath::testing {

/// The same request with limits smaller by a share: its profiles keep the original limits at all places of a
/// dense check.
inline ProfileRequest with_room(ProfileRequest request, double share) {
  Limits& limits = request.limits;
  for (double Limits::*limit :
       {&Limits::speed_m_s, &Limits::acceleration_m_s2, &Limits::deceleration_m_s2,
        &Limits::lateral_acceleration_m_s2, &Limits::yaw_rate_rad_s, &Limits::yaw_acceleration_rad_s2,
        &Limits::wheel_acceleration_rad_s2, &Limits::jerk_m_s3, &Limits::traction_coefficient})
    limits.*limit *= 1 - share;
  for (Motor* motor : {&request.plant.robot.motor.left, &request.plant.robot.motor.right}) {
    motor->max_current_A *= 1 - share;
    motor->max_voltage_V *= 1 - share;
  }
  if (request.time.mode == TimeMode::time_budget) request.time.duration_s *= 1 - 1e-9;
  return request;
}

}  // namespace joulepath::testing
