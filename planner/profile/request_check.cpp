#include "planner/profile/request_check.hpp"

#include <cmath>

#include "planner/profile/infeasibility_finder.hpp"

namespace joulepath {

std::optional<Infeasibility> senseless(const ProfileRequest& request) {
  const double length = piece_length(request.piece);
  if (!(std::isfinite(length) && length > 0))
    return explain_request(request, "path", "the path has no length: nothing to drive");
  if (!(request.start_rate >= 0) || !(request.end_rate >= 0) ||
      !std::isfinite(request.start_rate + request.end_rate))
    return explain_request(request, "start_speed", "start and end speed must be 0 or more");
  const Limits& limits = request.limits;
  for (double limit : {limits.speed_m_s, limits.acceleration_m_s2, limits.deceleration_m_s2,
                       limits.lateral_acceleration_m_s2, limits.yaw_rate_rad_s,
                       limits.yaw_acceleration_rad_s2, limits.wheel_acceleration_rad_s2,
                       limits.traction_coefficient, limits.motor_power_W, limits.battery_power_W})
    if (!(limit >= 0)) return explain_request(request, "limits", "a limit must be a number of 0 or more");
  if (std::isnan(limits.jerk_m_s3))
    return explain_request(request, "limits", "a jerk limit must be a number");
  if (!(request.payload.from_kg >= 0) || !(request.payload.to_kg >= 0))
    return explain_request(request, "payload", "a payload must be a number of 0 or more");
  return std::nullopt;
}

}  // namespace joulepath
