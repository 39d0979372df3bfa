#include "planner/legs/on_ways.hpp"

namespace joulepath {

MissionRequest on_ways_of(const Plan& plan, const MissionRequest& mission) {
  MissionRequest given = mission;
  if (plan.visit) given.legs = plan.visit->legs, given.visit.clear();
  if (mission.charging || given.legs.size() != plan.legs.size()) return mission;
  for (std::size_t k = 0; k < given.legs.size(); ++k) {
    if (given.legs[k].motion) continue;
    Path path;
    for (const StretchPlan& stretch : plan.legs[k].stretches) path.pieces.push_back(stretch.request.piece);
    given.legs[k].path = PathRequest{.frame = PathRequest::Frame::map, .ready = std::move(path)};
  }
  return given;
}

}  // namespace joulepath
