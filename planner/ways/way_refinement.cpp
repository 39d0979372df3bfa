#include "planner/ways/way_refinement.hpp"

#include <cmath>

// Design: docs/decisions/0211-whole-curves.md
namespace joulepath {
namespace {

constexpr double kAnyHeading = -100;

void append(std::vector<double>& key, const FreeSpline& spline) {
  key.insert(key.end(), {spline.start_heading_rad, spline.start_handle_m, spline.goal_heading_rad,
                         spline.goal_handle_m});
  for (const Point2& point : spline.points_m) key.insert(key.end(), point.begin(), point.end());
}

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

bool RefinedRun::drivable(std::size_t k, const Path& path) const {
  const std::size_t index = run_.first + k;
  return is_drivable(path, run_.contexts[k].mission.legs[index], index, run_.contexts[k]);
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
  return turn_after(k, path.end().heading_rad);
}

PathScore RefinedRun::turn_after(std::size_t k, double arrives_rad) const {
  const ChainLeg& leg = request_.legs[k];
  const std::optional<double> after_rad = heading_after(k);
  if (!after_rad) return {.drivable = true};
  if (!request_.may_turn(leg.goal, arrives_rad, *after_rad)) return {};
  return leg.turns->turn(arrives_rad, *after_rad, leg.goal_payload_kg);
}

/// Cost of the turn after the leg by the heading of its arrival; none where any heading will do.
std::function<double(double)> RefinedRun::turning_J(std::size_t k) const {
  if (request_.legs[k].goal_heading_rad || !heading_after(k)) return {};
  return [this, k](double arrives_rad) {
    return turn_after(k, arrives_rad).cost_J(run_.contexts[k].finite_price_W());
  };
}

PathScore RefinedRun::driving(std::size_t k, const Path& path) const {
  const std::size_t index = run_.first + k;
  return score_path(path, run_.contexts[k].mission.legs[index], index, run_.contexts[k]);
}

/// Score of a path between the neighbors' headings, turns at both stops included.
PathScore RefinedRun::score(std::size_t k, const Path& path) const {
  PathScore sum = turn_before(k, path);
  sum += turn_after(k, path);
  if (sum.drivable) sum += driving(k, path);
  return sum;
}

/// Score of the leg's present path.
PathScore RefinedRun::score(std::size_t k) const {
  PathScore sum = turn_before(k, parts_[k].path);
  sum += turn_after(k, parts_[k].path);
  return sum += parts_[k].driving;
}

void RefinedRun::take(std::size_t k, const Path& path) {
  Part& part = parts_[k];
  part.path = path;
  part.driving = driving(k, path);
  part.leaves_rad = part.path.start().heading_rad;
  part.arrives_rad = part.path.end().heading_rad;
  part.refined = true;
}

/// Curves of a leg that leave in a heading and arrive in the heading asked, else in any.
const std::vector<SwingResult>& RefinedRun::swings(std::size_t k, double leaves_rad,
                                                   const std::optional<double>& arrives_rad) {
  const Part& part = parts_[k];
  const std::vector<double> key{static_cast<double>(k),
                                leaves_rad,
                                arrives_rad.value_or(kAnyHeading),
                                heading_after(k).value_or(kAnyHeading),
                                part.leaves_rad,
                                part.arrives_rad,
                                part.path.distance_m(),
                                part.driving.energy_J};
  const auto [entry, fresh] = known_swings_.try_emplace(key);
  if (!fresh) return entry->second;
  const ChainLeg& leg = request_.legs[k];
  SwingRequest request{.start = part.path.start(), .goal_m = {leg.goal.x_m, leg.goal.y_m}};
  request.start.heading_rad = leaves_rad;
  request.goal_heading_rad = arrives_rad;
  if (part.path.pieces.size() == 1) request.along = std::get_if<Curve>(&part.path.pieces.front());
  LegDrafts drafts(run_.contexts[k], run_.first + k,
                   arrives_rad ? std::function<double(double)>() : turning_J(k));
  return entry->second = best_swings(request, run_.contexts[k].space->checker(), drafts);
}

/// The curves through the stop after leg k: that leg's first guess is `arriving`, the next one's its spline.
const std::optional<StopResult>& RefinedRun::stop_swing(std::size_t k, const FreeSpline& arriving) {
  const FreeSpline& leaving = *parts_[k + 1].spline;
  std::vector<double> key{static_cast<double>(k), heading_after(k + 1).value_or(kAnyHeading)};
  append(key, arriving);
  append(key, leaving);
  const auto [entry, fresh] = known_stops_.try_emplace(key);
  if (!fresh) return entry->second;
  LegDrafts before(run_.contexts[k], run_.first + k),
      after(run_.contexts[k + 1], run_.first + k + 1, turning_J(k + 1));
  return entry->second =
             best_stop({.before = arriving, .after = leaving, .drafts_before = before, .drafts_after = after},
                       run_.contexts[k].space->checker());
}

/// Replaces the leg's path by the cheapest curve that leaves in a heading; false where none is cheaper.
bool RefinedRun::swing_from(std::size_t k, double leaves_rad, bool checked) {
  const double price_W = run_.contexts[k].finite_price_W(), found = score(k).cost_J(price_W);
  for (const SwingResult& result : swings(k, leaves_rad, request_.legs[k].goal_heading_rad)) {
    if (score(k, result.path).cost_J(price_W) >= found) return false;
    if (checked && !drivable(k, result.path)) continue;
    take(k, result.path);
    parts_[k].spline = result.spline;
    return true;
  }
  return false;
}

/// Where no curve from the robot's heading is cheaper, one from the heading of the way may be, and lead to
/// the next stops.
void RefinedRun::swing_leg(std::size_t k, bool checked) {
  const double leaves_rad = parts_[k].leaves_rad;
  const double before_rad = heading_before(k).value_or(leaves_rad);
  if (swing_from(k, before_rad, checked)) return;
  if (!same_heading(before_rad, leaves_rad)) swing_from(k, leaves_rad, checked);
}

/// Optimizes the stop between legs k and k + 1. Where the robot turns there, the first leg is searched again,
/// towards the heading in which the second one leaves.
void RefinedRun::swing_through(std::size_t k, bool checked) {
  Part &before = parts_[k], &after = parts_[k + 1];
  if (request_.legs[k].goal_heading_rad || !after.spline) return;
  std::optional<FreeSpline> arriving = before.spline;
  if (!arriving || !same_heading(before.arrives_rad, after.leaves_rad)) {
    const std::vector<SwingResult> found =
        swings(k, heading_before(k).value_or(before.leaves_rad), after.leaves_rad);
    if (found.empty()) return;
    arriving = found.front().spline;
  }
  const double before_W = run_.contexts[k].finite_price_W(), after_W = run_.contexts[k + 1].finite_price_W();
  const double found = score(k).cost_J(before_W) + after.driving.cost_J(after_W) +
                       turn_after(k + 1, after.path).cost_J(after_W);
  const std::optional<StopResult>& result = stop_swing(k, *arriving);
  if (!result) return;
  const double cost = turn_before(k, result->before.path).cost_J(before_W) +
                      driving(k, result->before.path).cost_J(before_W) +
                      driving(k + 1, result->after.path).cost_J(after_W) +
                      turn_after(k + 1, result->after.path).cost_J(after_W);
  if (!(cost < found)) return;
  if (checked && !(drivable(k, result->before.path) && drivable(k + 1, result->after.path))) return;
  take(k, result->before.path);
  take(k + 1, result->after.path);
  before.spline = result->before.spline;
  after.spline = result->after.spline;
}

void RefinedRun::swing_all(std::size_t first, std::size_t count, bool checked) {
  const std::size_t end = first + count;
  for (std::size_t k = first; k < end; ++k)
    if (!parts_[k].barred) swing_leg(k, checked);
  for (std::size_t k = first; k + 1 < end; ++k)
    if (!parts_[k].barred && !parts_[k + 1].barred) swing_through(k, checked);
}

void RefinedRun::swing(std::size_t first, std::size_t count) {
  const std::vector<Part> before = parts_;
  swing_all(first, count, false);
  for (std::size_t k = first; k < first + count; ++k)
    if (parts_[k].spline && !drivable(k, parts_[k].path)) {
      parts_ = before;
      return swing_all(first, count, true);
    }
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
