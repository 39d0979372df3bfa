#include <algorithm>
#include <cmath>

#include "planner/joint/joint_search.hpp"
#include "planner/ways/way_refinement.hpp"

// Design: docs/decisions/0212-joint-path-and-speed.md
namespace joulepath {
namespace {

using joint::Sketch;

constexpr std::size_t kMostTogether = 3;  ///< legs in one program
constexpr std::size_t kMostStarts = 8;    ///< beside the present paths
constexpr std::size_t kFewStarts = 2;     ///< of legs that turn little
constexpr std::size_t kMostReverse = 12;  ///< starts with a part in reverse: of words, and of routes
constexpr std::size_t kMostTurning = 4;   ///< starts with a turn in place at an end
constexpr double kTight_m = 0.1;          ///< of room at an end: an arc that turns there may not fit
const std::vector<double> kWordRadii_m{0.15, 0.5}, kCuspRadii_m{0.25}, kStraight_m{0.3, 0.9, 1.8};

/// More for a longer path and for one that turns more.
std::size_t pieces_for(const Path& path) {
  double turned_rad = 0;
  constexpr int kPlaces = 200;
  for (const PathPiece& piece : path.pieces)
    for (int i = 0; i < kPlaces && !is_turn(piece); ++i) {
      const double length_m = piece_length(piece), step_m = length_m / kPlaces;
      turned_rad += step_m * std::abs(piece_bend(piece, (i + 0.5) * step_m).curvature_per_m);
    }
  const double count = 6 + 0.5 * std::min(path.distance_m(), 12.0) + 2.5 * turned_rad;
  return static_cast<std::size_t>(std::min(count, 40.0));
}

/// Whether a path is a straight line but for a turn by about 5e-6 rad, which costs less than 0.1 %: the
/// search would cost more than it saves.
bool is_straight(const Sketch& along, const Path& path) {
  constexpr double kTurning_m = 2e-6;  ///< of the wheels
  return along.effort_m() <= path.distance_m() + kTurning_m;
}

/// Whether turning is a notable share of what the wheels roll: else one basin holds the best path.
bool turns_much(const Sketch& along, const Path& path) {
  constexpr double kNotable = 1.02;
  return along.effort_m() > kNotable * path.distance_m();
}

/// Keeps the starts with the least effort.
std::vector<std::vector<Sketch>> easiest(std::vector<std::vector<Sketch>> starts, std::size_t most) {
  const auto effort_m = [](const std::vector<Sketch>& legs) {
    double sum = 0;
    for (const Sketch& leg : legs) sum += leg.effort_m();
    return sum;
  };
  std::stable_sort(starts.begin(), starts.end(),
                   [&](const auto& a, const auto& b) { return effort_m(a) < effort_m(b); });
  if (starts.size() > most) starts.resize(most);
  return starts;
}

bool is_tight(const FreeSpace& room, double x_m, double y_m) {
  return !room.field().disc_free(x_m, y_m, room.radius_m() + kTight_m);
}

bool turns_in_place(const Path& path) {
  return std::any_of(path.pieces.begin(), path.pieces.end(),
                     [](const PathPiece& piece) { return is_turn(piece); });
}

void append_all(std::vector<std::vector<Sketch>>& starts, std::vector<std::vector<Sketch>> more) {
  std::move(more.begin(), more.end(), std::back_inserter(starts));
}

void append_each(std::vector<std::vector<Sketch>>& starts, std::vector<Sketch> sketches) {
  for (Sketch& sketch : sketches) starts.push_back({std::move(sketch)});
}

}  // namespace

joint::DriveLaw RefinedRun::law_of(std::size_t k, int direction) const {
  const ChoiceContext& context = run_.contexts[k];
  const LegRequest& asked = context.mission.legs[run_.first + k];
  Limits limits = limits_along(context.world.robot, asked.payload);
  if (asked.yaw_rate_rad_s) limits.yaw_rate_rad_s = std::min(limits.yaw_rate_rad_s, *asked.yaw_rate_rad_s);
  if (direction < 0) limits.speed_m_s = std::min(limits.speed_m_s, limits.reverse_speed_m_s);
  if (context.options.steps.mean_ramps) {
    const double most_m_s2 = mean_ramp_m_s2(parts_[k].path.distance_m(), limits);
    limits.acceleration_m_s2 = std::min(limits.acceleration_m_s2, most_m_s2);
    limits.deceleration_m_s2 = std::min(limits.deceleration_m_s2, most_m_s2);
  }
  return joint::drive_law(context.plant, limits, 0.5 * (asked.payload.from_kg + asked.payload.to_kg),
                          parts_[k].path.start(), context.finite_price_W(), direction);
}

bool RefinedRun::may_drive(std::size_t k, int direction) const {
  const LegRequest& asked = run_.contexts[k].mission.legs[run_.first + k];
  return direction > 0 ? asked.direction != LegDirection::reverse
                       : may_reverse(run_.contexts[k].world.robot, asked);
}

/// The drives along a route that the leg's direction allows.
std::vector<RouteDrive> RefinedRun::drives(std::size_t k) const {
  std::vector<RouteDrive> drives;
  for (const RouteDrive drive : kRouteDrives)
    if ((drive == RouteDrive::reverse || may_drive(k, 1)) &&
        (drive == RouteDrive::forward || may_drive(k, -1)))
      drives.push_back(drive);
  return drives;
}

/// Words in reverse, and with one cusp: near an end, or at the first place with room to turn.
std::vector<Sketch> RefinedRun::backward_words(std::size_t k, const joint::JointQuery& query) const {
  const double half_track_m = query.laws.front().half_track_m;
  const joint::LegGoal& goal = query.goals.front();
  std::vector<Sketch> all = joint::reverse_words(query.start, goal, half_track_m, kWordRadii_m);
  if (!may_drive(k, 1)) return all;
  std::vector<double> straight_m = kStraight_m;
  for (const int direction : {1, -1}) {
    const FreeSpace& room = run_.contexts[k].space->any_heading();
    const Pose at_goal{goal.at_m[0], goal.at_m[1], goal.heading_rad.value_or(0)};
    if (const auto out_m = way_to_room_m(room, query.start, direction)) straight_m.push_back(*out_m);
    if (!goal.heading_rad) continue;
    if (const auto in_m = way_to_room_m(room, at_goal, direction)) straight_m.push_back(*in_m);
  }
  for (Sketch& word : joint::cusp_words(query.start, goal, half_track_m, kCuspRadii_m, straight_m))
    all.push_back(std::move(word));
  return all;
}

/// Arcs and lines along every route of a single leg.
RefinedRun::Starts RefinedRun::rough_paths(std::size_t k, const joint::JointQuery& query,
                                           RouteDrive drive) const {
  const joint::LegGoal& goal = query.goals.front();
  Starts all;
  for (const PooledRoute& route : run_.routes[k].routes)
    if (route.polyline_m.size() > 2)
      for (const int begin : {1, -1})
        for (const int end : goal.heading_rad ? std::vector<int>{1, -1} : std::vector<int>{0})
          if (auto sketch =
                  sketch_along(drive, query.start, goal, route.polyline_m, begin, end,
                               query.laws.front().half_track_m, run_.contexts[k].space->any_heading()))
            all.push_back({std::move(*sketch)});
  return all;
}

/// Along every route of a single leg, with turns in place at the ends that have hardly any room but that.
RefinedRun::Starts RefinedRun::turning_paths(std::size_t k, const joint::JointQuery& query) const {
  const joint::LegGoal& goal = query.goals.front();
  const FreeSpace& room = run_.contexts[k].space->any_heading();
  const Pose at_goal{goal.at_m[0], goal.at_m[1], goal.heading_rad.value_or(0)};
  const std::vector<int> none{0}, each{0, 1, -1};
  const auto turns = [&](const Pose& place, double from_rad, double to_rad) {
    return is_tight(room, place.x_m, place.y_m) && request_.may_turn(place, from_rad, to_rad) ? each : none;
  };
  Starts all;
  if (!may_drive(k, 1)) return all;
  for (const PooledRoute& route : run_.routes[k].routes) {
    const std::vector<Point2>& line = route.polyline_m;
    if (line.size() < 2) continue;
    const double leaves_rad = bearing_rad(line[0], line[1]),
                 arrives_rad = bearing_rad(line[line.size() - 2], line.back());
    for (const int first : turns(query.start, query.start.heading_rad, leaves_rad))
      for (const int last : goal.heading_rad ? turns(at_goal, arrives_rad, *goal.heading_rad) : none)
        if (first != 0 || last != 0)
          all.push_back({joint::along_route_turning(query.start, line, goal.heading_rad, first, last,
                                                    query.laws.front().half_track_m)});
  }
  return easiest(std::move(all), kMostTurning);
}

/// Along the chosen routes of several legs, each with a drive of its own.
RefinedRun::Starts RefinedRun::rough_chains(std::size_t first, const joint::JointQuery& query,
                                            const std::vector<RouteDrive>& drives) const {
  const double half_track_m = query.laws.front().half_track_m;
  Starts all;
  for (const int begin : {1, -1})
    for (const int end : query.goals.back().heading_rad ? std::vector<int>{1, -1} : std::vector<int>{0}) {
      std::vector<Sketch> legs;
      Pose from = query.start;
      for (std::size_t i = 0; i < query.goals.size(); ++i) {
        const bool last = i + 1 == query.goals.size();
        const PooledRoute& route = run_.routes[first + i].routes[parts_[first + i].way->route];
        auto sketch =
            sketch_along(drives[i], from, query.goals[i], route.polyline_m, i == 0 ? begin : 0,
                         last ? end : 0, half_track_m, run_.contexts[first + i].space->any_heading());
        if (!sketch) break;
        legs.push_back(std::move(*sketch));
        from = {query.goals[i].at_m[0], query.goals[i].at_m[1],
                from.heading_rad + legs.back().turn_rad(half_track_m)};
      }
      if (legs.size() == query.goals.size()) all.push_back(std::move(legs));
    }
  return all;
}

/// Each choice of a drive for each leg.
std::vector<std::vector<RouteDrive>> RefinedRun::drive_choices(std::size_t first, std::size_t count) const {
  std::vector<std::vector<RouteDrive>> choices{{}};
  for (std::size_t k = first; k < first + count; ++k) {
    std::vector<std::vector<RouteDrive>> longer;
    for (const auto& choice : choices)
      for (const RouteDrive drive : drives(k)) {
        longer.push_back(choice);
        longer.back().push_back(drive);
      }
    choices = std::move(longer);
  }
  return choices;
}

/// Starts whose legs drive forward, and those with a part in reverse.
std::array<RefinedRun::Starts, 2> RefinedRun::joint_starts(std::size_t first,
                                                           const joint::JointQuery& query) const {
  const bool alone = query.goals.size() == 1;
  const joint::LegGoal& goal = query.goals.front();
  std::array<Starts, 2> starts;
  Starts backward;
  if (alone && may_drive(first, 1))
    append_each(starts[0], joint::words(query.start, goal, query.laws.front().half_track_m, kWordRadii_m));
  if (alone && may_drive(first, -1)) append_each(starts[1], backward_words(first, query));
  for (const auto& drives : drive_choices(first, query.goals.size())) {
    auto more = alone ? rough_paths(first, query, drives.front()) : rough_chains(first, query, drives);
    const bool forward = std::all_of(drives.begin(), drives.end(),
                                     [](RouteDrive drive) { return drive == RouteDrive::forward; });
    append_all(forward ? starts[0] : backward, std::move(more));
  }
  starts = {easiest(std::move(starts[0]), kMostStarts), easiest(std::move(starts[1]), kMostReverse)};
  append_all(starts[1], easiest(std::move(backward), kMostReverse));
  return starts;
}

/// Each leg alone, from the arrival of the one before: a start for all of them together. The coarse grid
/// tells differences of energy well enough, those of time not, unless the leg is known.
RefinedRun::Starts RefinedRun::one_by_one(std::size_t first, const joint::JointQuery& query) const {
  std::vector<Sketch> legs;
  Pose from = query.start;
  for (std::size_t i = 0; i < query.goals.size(); ++i) {
    const joint::JointQuery leg{.start = from,
                                .goals = {query.goals[i]},
                                .laws = {query.laws[i]},
                                .reverse_laws = {query.reverse_laws[i]},
                                .checker = query.checker};
    const auto best = [&](const Starts& starts) -> std::optional<joint::JointPaths> {
      if (std::isfinite(run_.contexts[first + i].price_W)) return joint::best_coarse_paths(leg, starts);
      std::vector<joint::JointPaths> fine = joint::best_joint_paths(leg, starts);
      return fine.empty() ? std::nullopt : std::optional(std::move(fine.front()));
    };
    std::optional<joint::JointPaths> found;
    if (const auto& known = parts_[first + i].sketch) found = joint::best_coarse_paths(leg, {{*known}});
    if (!found) {
      auto [forward, backward] = joint_starts(first + i, leg);
      append_all(forward, turning_paths(first + i, leg));
      found = best(forward);
      if (!found) found = best(backward);
    }
    if (!found) return {};
    legs.push_back(std::move(found->sketches.front()));
    from = found->legs.front().end();
  }
  return {legs};
}

/// Cost of the legs along their present paths, on the plan's grid but for turns, those at their stops
/// included.
double RefinedRun::driven_J(std::size_t first, std::size_t count) const {
  const std::vector<LegPath> all = paths();
  double cost_J = 0;
  for (std::size_t k = first; k < first + count && std::isfinite(cost_J); ++k) {
    const ChoiceContext& context = run_.contexts[k];
    const std::size_t leg = run_.first + k;
    cost_J += score_path(all[k].path, context.mission.legs[leg], leg, context, context.options.nodes)
                  .cost_J(context.finite_price_W());
  }
  return cost_J;
}

/// Whether the legs have profiles along their present paths within every limit.
bool RefinedRun::drivable(std::size_t first, std::size_t count) const {
  const std::vector<LegPath> all = paths();
  for (std::size_t k = first; k < first + count; ++k) {
    const std::size_t leg = run_.first + k;
    if (!is_drivable(all[k].path, run_.contexts[k].mission.legs[leg], leg, run_.contexts[k])) return false;
  }
  return true;
}

void RefinedRun::take(std::size_t first, const joint::JointPaths& joined) {
  for (std::size_t i = 0; i < joined.legs.size(); ++i) {
    Part& part = parts_[first + i];
    part.path = joined.legs[i];
    part.leaves_rad = part.path.start().heading_rad;
    part.arrives_rad = part.path.end().heading_rad;
    part.sketch = joined.sketches[i];
    part.refined = true;
    part.barred = false;
  }
}

/// The cheapest of the present paths and those of the joint program that keeps every limit; the present ones
/// where none does. A leg that is joined again is checked then. Returns whether a path of the program was
/// taken.
bool RefinedRun::take_cheapest(std::size_t first, std::size_t count, const joint::JointQuery& query,
                               const std::array<Starts, 2>& starts, double present_J) {
  struct Candidate {
    double cost_J{};
    std::vector<Part> parts{};
    bool joined{};
  };
  const std::vector<Part> present = parts_;
  std::vector<Candidate> candidates;
  if (std::isfinite(present_J)) candidates.push_back({present_J, present, false});
  for (const Starts& group : starts)
    for (const joint::JointPaths& joined : joint::best_joint_paths(query, group)) {
      parts_ = present;
      take(first, joined);
      if (const double cost_J = driven_J(first, count); std::isfinite(cost_J))
        candidates.push_back({cost_J, parts_, true});
    }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.cost_J < b.cost_J; });
  for (Candidate& candidate : candidates) {
    parts_ = std::move(candidate.parts);
    if (!drivable(first, joins_again(first, count) ? count - 1 : count)) continue;
    for (std::size_t k = first; k < first + count; ++k)
      if (parts_[k].refined) parts_[k].driving = driving(k, parts_[k].path);
    return candidate.joined;
  }
  parts_ = present;
  return false;
}

/// A limit of zero forbids every curve; the joint program begins and ends at rest.
bool RefinedRun::may_join(std::size_t k) const {
  const LegRequest& asked = run_.contexts[k].mission.legs[run_.first + k];
  const Limits limits = law_of(k, 1).limits;
  return asked.start_speed_m_s == 0 && asked.end_speed_m_s == 0 && limits.yaw_rate_rad_s > 0 &&
         limits.lateral_acceleration_m_s2 > 0 && limits.yaw_acceleration_rad_s2 > 0;
}

/// Returns whether a path of the joint program was taken, or none is needed.
bool RefinedRun::join(std::size_t first, std::size_t count) {
  joint::JointQuery query{.start = first == 0 ? request_.start : request_.legs[first - 1].goal,
                          .checker = &run_.contexts[first].space->checker()};
  query.start.heading_rad = heading_before(first).value_or(parts_[first].leaves_rad);
  const std::vector<LegPath> present = paths();
  std::vector<Sketch> from_present;
  const double half_track_m = run_.contexts[first].world.robot.geometry.half_track_m;
  bool bends = false, barred = false, turning = false, tight = false;
  for (std::size_t k = first; k < first + count; ++k) {
    const Path& path = present[k].path;
    const FreeSpace& room = run_.contexts[k].space->any_heading();
    from_present.push_back(
        parts_[k].sketch ? *parts_[k].sketch
                         : joint::along_path(path, half_track_m, pieces_for(path), joint::Turns::as_arcs));
    for (const Pose& end : {path.start(), path.end()})
      tight = tight || (turns_in_place(path) && is_tight(room, end.x_m, end.y_m));
    barred = barred || parts_[k].barred;
    bends = bends || !is_straight(from_present.back(), path);
    turning = turning || turns_much(from_present.back(), path);
  }
  if (!bends && !barred) return true;
  for (std::size_t k = first; k < first + count; ++k) {
    query.laws.push_back(law_of(k, 1));
    query.reverse_laws.push_back(law_of(k, -1));
    const Pose& goal = request_.legs[k].goal;
    const bool last = k + 1 == first + count;
    query.goals.push_back({{goal.x_m, goal.y_m}, last ? heading_after(k) : std::nullopt});
  }
  const double present_J = barred ? kNoLimit : driven_J(first, count);
  auto starts = joint_starts(first, query);
  if (!turning && !barred) starts = {easiest(std::move(starts[0]), kFewStarts), Starts{}};
  if (count == 1) append_all(starts[0], turning_paths(first, query));
  if (count > 1)
    if (Starts sequence = one_by_one(first, query); !sequence.empty()) starts[0] = std::move(sequence);
  if (std::isfinite(present_J)) {
    starts[0].push_back(std::move(from_present));
    if (tight) {
      std::vector<Sketch>& turning_present = starts[0].emplace_back();
      for (std::size_t k = first; k < first + count; ++k)
        turning_present.push_back(
            along_path(present[k].path, half_track_m, pieces_for(present[k].path), joint::Turns::in_place));
    }
  }
  return take_cheapest(first, count, query, starts, present_J);
}

bool RefinedRun::barred() const {
  return std::any_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.barred; });
}

/// Whether the last of these legs is the first of the next ones, too: its second path knows both neighbors.
bool RefinedRun::joins_again(std::size_t first, std::size_t count) const {
  const std::size_t end = first + count;
  return count == kMostTogether && end < parts_.size() && may_join(end);
}

void RefinedRun::join() {
  const std::size_t legs = parts_.size();
  for (std::size_t first = 0; first < legs;) {
    std::size_t end = first;
    while (end < legs && end < first + kMostTogether && may_join(end)) ++end;
    if (end > first && !join(first, end - first) && end > first + 1)
      for (std::size_t k = first; k < end; ++k) join(k, 1);  // each alone, as the others are now
    first = joins_again(first, end - first) ? end - 1 : std::max(end, first + 1);
  }
}

}  // namespace joulepath
