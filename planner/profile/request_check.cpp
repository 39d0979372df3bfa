#include "planner/profile/request_check.hpp"

#include <cmath>

#include "model/limit_table.hpp"
#include "planner/profile/infeasibility_finder.hpp"

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
  return std::nullopt;
}

}  // namespace joulepath
