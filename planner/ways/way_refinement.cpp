#include "planner/ways/way_refinement.hpp"

namespace joulepath {

RefinedRun::RefinedRun(const ChainRequest& request, const std::vector<ChainChoice>& chain, const WayRun& run)
    : request_(request), run_(run) {
  for (std::size_t k = 0; k < chain.size(); ++k) {
    const Way& way = (*request.legs[k].ways)[chain[k].way];
    parts_.push_back({.way = &way,
                      .path = way.path,
                      .driving = way.score,
                      .leaves_rad = way.leaves_rad,
                      .arrives_rad = way.arrives_rad,
                      .turns_at_goal = chain[k].goal_heading_rad.has_value()});
  }
  for (std::size_t k = 0; k < chain.size(); ++k) parts_[k].barred = !may_drive(k, 1) || !score(k).drivable;
}

/// The robot's heading before the leg; absent where any heading is possible.
std::optional<double> RefinedRun::heading_before(std::size_t k) const {
  if (k == 0) return request_.start_heading_free ? std::nullopt : std::optional(request_.start.heading_rad);
  if (request_.legs[k - 1].goal_heading_rad) return request_.legs[k - 1].goal_heading_rad;
  return parts_[k - 1].arrives_rad;
}

/// The heading in which the robot leaves the stop at the leg's end, or which the station names.
std::optional<double> RefinedRun::heading_after(std::size_t k) const {
  if (request_.legs[k].goal_heading_rad) return request_.legs[k].goal_heading_rad;
  if (k + 1 < parts_.size()) return parts_[k + 1].leaves_rad;
  return std::nullopt;
}

PathScore RefinedRun::turn_before(std::size_t k, const Path& path) const {
  const Pose& place = k == 0 ? request_.start : request_.legs[k - 1].goal;
  const double leaves_rad = path.start().heading_rad;
  const std::optional<double> before_rad = heading_before(k);
  if (!before_rad) return {.drivable = true};
  if (!request_.may_turn(place, *before_rad, leaves_rad)) return {};
  return request_.legs[k].turns->turn(*before_rad, leaves_rad, request_.legs[k].start_payload_kg);
}

PathScore RefinedRun::turn_after(std::size_t k, const Path& path) const {
  const ChainLeg& leg = request_.legs[k];
  const double arrives_rad = path.end().heading_rad;
  const std::optional<double> after_rad = heading_after(k);
  if (!after_rad) return {.drivable = true};
  if (!request_.may_turn(leg.goal, arrives_rad, *after_rad)) return {};
  return leg.turns->turn(arrives_rad, *after_rad, leg.goal_payload_kg);
}

PathScore RefinedRun::driving(std::size_t k, const Path& path) const {
  const std::size_t index = run_.first + k;
  const ChoiceContext& context = run_.contexts[k];
  return score_path(path, context.mission.legs[index], index, context, context.options.nodes);
}

/// Score of the leg's present path.
PathScore RefinedRun::score(std::size_t k) const {
  PathScore sum = turn_before(k, parts_[k].path);
  sum += turn_after(k, parts_[k].path);
  return sum += parts_[k].driving;
}

std::vector<LegPath> RefinedRun::paths() const {
  std::vector<LegPath> paths;
  Pose here = request_.start;
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const Part& part = parts_[k];
    Path path;
    if (k > 0 || !request_.start_heading_free) append_turn_to(path, here, part.leaves_rad);
    path.pieces.insert(path.pieces.end(), part.path.pieces.begin(), part.path.pieces.end());
    if (part.turns_at_goal) append_turn_to(path, here, *heading_after(k));
    here = path.end();
    paths.push_back({.path = std::move(path)});
  }
  return paths;
}

/// Energy and time of a leg as paths() returns it: a turn at a stop counts on the leg that makes it.
PathScore RefinedRun::as_driven(std::size_t k) const {
  PathScore sum = parts_[k].driving;
  const bool turned_already = k > 0 && parts_[k - 1].turns_at_goal && !request_.legs[k - 1].goal_heading_rad;
  if (!turned_already) sum += turn_before(k, parts_[k].path);
  if (parts_[k].turns_at_goal) sum += turn_after(k, parts_[k].path);
  return sum;
}

void RefinedRun::tell(std::size_t k, LegPath& path) const {
  const Part& part = parts_[k];
  const PathScore driven = as_driven(k);
  path.improvements.push_back({.step = "refinement",
                               .energy_J = driven.energy_J,
                               .duration_s = driven.duration_s,
                               .cost_J = driven.cost_J(request_.legs[k].price_W)});
  if (!part.refined) return;
  for (PathAlternative& alternative : path.alternatives) alternative.chosen = false;
  const PathScore between = score(k);
  path.alternatives.push_back({.name = part.way->name + "_refined",
                               .energy_J = between.energy_J,
                               .duration_s = between.duration_s,
                               .distance_m = part.path.distance_m(),
                               .chosen = true});
}

}  // namespace joulepath
