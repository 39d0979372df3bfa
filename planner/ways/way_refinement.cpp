#include "planner/ways/way_refinement.hpp"

#include <cmath>

#include "planner/path/shape/refine.hpp"
#include "planner/ways/swing.hpp"

namespace joulepath {
namespace {

bool same_heading(const std::optional<double>& a_rad, double b_rad) {
  return a_rad && std::abs(wrapped_angle_rad(*a_rad - b_rad)) < 1e-6;
}

}  // namespace

RefinedRun::RefinedRun(const ChainRequest& request, const std::vector<ChainChoice>& chain, const WayRun& run)
    : request_(request), run_(run) {
  for (std::size_t k = 0; k < chain.size(); ++k) {
    const Way& way = (*request.legs[k].ways)[chain[k].way];
    parts_.push_back({.way = &way,
                      .path = way.path,
                      .leaves_rad = way.leaves_rad,
                      .arrives_rad = way.arrives_rad,
                      .turns_at_goal = chain[k].goal_heading_rad.has_value(),
                      .score = chain[k].score});
  }
}

/// In which the robot stands before the leg; absent where any heading will do.
std::optional<double> RefinedRun::heading_before(std::size_t k) const {
  if (k == 0) return request_.start_heading_free ? std::nullopt : std::optional(request_.start.heading_rad);
  if (request_.legs[k - 1].goal_heading_rad) return request_.legs[k - 1].goal_heading_rad;
  return parts_[k - 1].arrives_rad;
}

/// In which the robot leaves the stop at the leg's end, or which the station names.
std::optional<double> RefinedRun::heading_after(std::size_t k) const {
  if (request_.legs[k].goal_heading_rad) return request_.legs[k].goal_heading_rad;
  if (k + 1 < parts_.size()) return parts_[k + 1].leaves_rad;
  return std::nullopt;
}

/// Of a path between the neighbors' headings, turns at both stops included.
PathScore RefinedRun::score(std::size_t k, const Path& path) const {
  const ChainLeg& leg = request_.legs[k];
  const Pose& place = k == 0 ? request_.start : request_.legs[k - 1].goal;
  const double leaves_rad = path.start().heading_rad, arrives_rad = path.end().heading_rad;
  const std::optional<double> before_rad = heading_before(k), after_rad = heading_after(k);
  if (before_rad && !request_.may_turn(place, *before_rad, leaves_rad)) return {};
  if (after_rad && !request_.may_turn(leg.goal, arrives_rad, *after_rad)) return {};
  PathScore sum{.drivable = true};
  if (before_rad) sum += leg.turns->turn(*before_rad, leaves_rad, leg.start_payload_kg);
  if (after_rad) sum += leg.turns->turn(arrives_rad, *after_rad, leg.goal_payload_kg);
  const std::size_t index = run_.first + k;
  sum += score_path(path, run_.contexts[k].mission.legs[index], index, run_.contexts[k]);
  return sum;
}

void RefinedRun::refine(std::size_t k) {
  Part& part = parts_[k];
  const double price_W = request_.legs[k].price_W;
  const RefineOptions options{.keep_start_heading = same_heading(heading_before(k), part.leaves_rad),
                              .keep_goal_heading = same_heading(heading_after(k), part.arrives_rad)};
  const RefineResult result = refine_path(
      run_.contexts[k].space->checker(), part.way->shape,
      [&](const Path& path) { return score(k, path).cost_J(price_W); }, options);
  if (!result.improved) return;
  take(part, k, result.path);
}

void RefinedRun::take(Part& part, std::size_t k, const Path& path) {
  const PathScore before = score(k, part.path), after = score(k, path);
  part.path = path;
  part.leaves_rad = part.path.start().heading_rad;
  part.arrives_rad = part.path.end().heading_rad;
  part.score.energy_J += after.energy_J - before.energy_J;
  part.score.duration_s += after.duration_s - before.duration_s;
  part.refined = true;
}

void RefinedRun::swing(std::size_t k) {
  Part& part = parts_[k];
  const ChoiceContext& context = run_.contexts[k];
  const double price_W = context.finite_price_W();
  const ChainLeg& leg = request_.legs[k];
  SwingRequest request{.start = part.path.start(), .goal_m = {leg.goal.x_m, leg.goal.y_m}};
  request.start.heading_rad = heading_before(k).value_or(part.leaves_rad);
  request.goal_heading_rad = leg.goal_heading_rad;
  if (part.path.pieces.size() == 1) request.along = std::get_if<Curve>(&part.path.pieces.front());
  const auto cost = [&](const Path& path) { return score(k, path).cost_J(price_W); };
  const std::optional<SwingResult> result = best_swing(request, context.space->checker(), cost);
  if (result && result->cost < cost(part.path)) take(part, k, result->path);
}

void RefinedRun::swing() {
  for (std::size_t k = 0; k < parts_.size(); ++k) swing(k);
}

void RefinedRun::refine() {
  for (std::size_t k = 0; k < parts_.size(); ++k) refine(k);
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

void RefinedRun::tell(std::size_t k, LegPath& path) const {
  const Part& part = parts_[k];
  path.improvements.push_back({.step = "refinement",
                               .energy_J = part.score.energy_J,
                               .duration_s = part.score.duration_s,
                               .cost_J = part.score.cost_J(request_.legs[k].price_W)});
  if (!part.refined) return;
  for (PathAlternative& alternative : path.alternatives) alternative.chosen = false;
  const PathScore between = score(k, part.path);
  path.alternatives.push_back({.name = part.way->name + "_refined",
                               .energy_J = between.energy_J,
                               .duration_s = between.duration_s,
                               .distance_m = part.path.distance_m(),
                               .chosen = true});
}

}  // namespace joulepath
