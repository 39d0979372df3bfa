#include "planner/profile/request_check.hpp"

#include <cmath>

#include "model/limit_table.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/profile/infeasibility_finder.hpp"
#include "planner/profile/place_cost.hpp"

namespace joulepath {

std::optional<Infeasibility> senseless(const ProfileRequest& request) {
  const double length = piece_length(request.piece);
  if (!(std::isfinite(length) && length > 0))
    return explain_request(request, "path", "the path has no length: nothing to drive");
  if (!(request.start_rate >= 0) || !(request.end_rate >= 0) ||
      !std::isfinite(request.start_rate + request.end_rate))
    return explain_request(request, "start_speed", "start and end speed must be 0 or more");
  for (const Limit& row : kLimits)
    for (const Side side : kSides)
      if (!(limit_of(row, request.limits, request.plant.robot.motor, side) >= 0))
        return explain_request(request, "limits", std::string(row.key) + " must be a number of 0 or more");
  if (!(request.payload.from_kg >= 0) || !(request.payload.to_kg >= 0))
    return explain_request(request, "payload", "a payload must be a number of 0 or more");
  if (slower_is_always_cheaper(request))
    return explain_request(request, "duration",
                           "slower is always cheaper: give a duration, a deadline or standby_W");
  return std::nullopt;
}

bool slower_is_always_cheaper(const ProfileRequest& request) {
  constexpr int kPlaces = 8;
  constexpr double kNothing = 1e-9;  ///< of the power at a usual speed
  const TimeGoal& time = request.time;
  const bool priced = time.mode == TimeMode::time_price;
  const bool open =
      time.mode == TimeMode::free_time ||
      ((priced || time.mode == TimeMode::time_budget) && std::isinf(time.duration_s));
  const double second_W = request.plant.robot.power.standby_W + (priced ? time.price_W : 0.0);
  if (!open || second_W > 0) return false;
  const double limit = is_turn(request.piece) ? request.limits.yaw_rate_rad_s : request.limits.speed_m_s;
  const double usual = std::isfinite(limit) ? limit : 1.0;
  const PathMotion motion = path_motion(request);
  const CostModel model(request, motion, second_W);
  for (int k = 0; k < kPlaces; ++k) {
    const PlaceCost place(model, motion.length() * (k + 0.5) / kPlaces, 0.0);
    if (place.at(0, 0) <= kNothing * std::abs(place.at(usual, 0))) return true;
  }
  return false;
}

}  // namespace joulepath
