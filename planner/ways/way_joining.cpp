#include <algorithm>
#include <cmath>

#include "planner/joint/joint_search.hpp"
#include "planner/legs/leg_timing.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/ways/way_refinement.hpp"

// Design: docs/decisions/0212-joint-path-and-speed.md
namespace joulepath {
namespace {

using joint::Sketch;

constexpr std::size_t kMostTogether = 3;  ///< legs in one program
constexpr std::size_t kMostStarts = 8;    ///< beside the present paths
const std::vector<double> kWordRadii_m{0.15, 0.5};

/// Cost of driving a leg along a path by the certified profile at the leg's price; infinite: none.
double certified_J(const Path& path, std::size_t leg, const ChoiceContext& context) {
  LegTiming timing(stretches_of(path, context.mission.legs[leg], leg, context.mission, context.world,
                                context.plant, context.options),
                   context.options.answers);
  const std::vector<ProfileResult>& results = timing.solve(context.price_W, SolverChoice::fast);
  double sum_J = 0;
  for (std::size_t k = 0; k < results.size(); ++k) {
    const std::optional<Profile>& profile = results[k].profile;
    if (!profile) return kNoLimit;
    sum_J += energy_by_cause(path_motion(timing.stretches()[k]), *profile).total_J() +
             context.finite_price_W() * profile->duration_s();
  }
  return sum_J;
}

/// A limit of zero forbids every curve.
bool may_join(const LegRequest& leg, const Limits& limits) {
  return leg.start_speed_m_s == 0 && leg.end_speed_m_s == 0 && limits.yaw_rate_rad_s > 0 &&
         limits.lateral_acceleration_m_s2 > 0 && limits.yaw_acceleration_rad_s2 > 0;
}

std::size_t pieces_for(const Path& path) {
  return std::min<std::size_t>(12, 6 + static_cast<std::size_t>(0.5 * path.distance_m()));
}

/// Whether turning is a notable share of what the wheels roll: on long straight ways the present curves are
/// as good, and the search would cost more than it saves.
bool turns_much(const Sketch& along, const Path& path) {
  constexpr double kNotable = 1.02;
  return along.effort_m() > kNotable * path.distance_m();
}

double effort_m(const std::vector<Sketch>& legs) {
  double sum = 0;
  for (const Sketch& leg : legs) sum += leg.effort_m();
  return sum;
}

}  // namespace

joint::DriveLaw RefinedRun::law_of(std::size_t k) const {
  const ChoiceContext& context = run_.contexts[k];
  const LegRequest& asked = context.mission.legs[run_.first + k];
  Limits limits = limits_along(context.world.robot, asked.payload);
  if (asked.yaw_rate_rad_s) limits.yaw_rate_rad_s = std::min(limits.yaw_rate_rad_s, *asked.yaw_rate_rad_s);
  return joint::drive_law(context.plant, limits, 0.5 * (asked.payload.from_kg + asked.payload.to_kg),
                          parts_[k].path.start(), context.finite_price_W());
}

/// Arcs and lines along every route of a single leg, along the chosen routes of several.
std::vector<std::vector<Sketch>> RefinedRun::rough_paths(std::size_t first,
                                                         const joint::JointQuery& query) const {
  const double half_track_m = query.laws.front().half_track_m;
  std::vector<std::vector<Sketch>> all;
  const auto along = [&](std::size_t leg, const Pose& from, const PooledRoute& route, int begin, int end) {
    return joint::along_route(from, route.polyline_m, query.goals[leg].heading_rad, begin, end, half_track_m);
  };
  const std::vector<int> lasts =
      query.goals.back().heading_rad ? std::vector<int>{1, -1} : std::vector<int>{0};
  if (query.goals.size() == 1) {
    for (Sketch& word : joint::words(query.start, query.goals[0], half_track_m, kWordRadii_m))
      all.push_back({std::move(word)});
    for (const PooledRoute& route : run_.routes[first].routes)
      if (route.polyline_m.size() > 2)
        for (const int begin : {1, -1})
          for (const int end : lasts) all.push_back({along(0, query.start, route, begin, end)});
  } else {
    for (const int begin : {1, -1})
      for (const int end : lasts) {
        std::vector<Sketch> legs;
        Pose from = query.start;
        for (std::size_t i = 0; i < query.goals.size(); ++i) {
          const bool last = i + 1 == query.goals.size();
          const PooledRoute& route = run_.routes[first + i].routes[parts_[first + i].way->route];
          legs.push_back(along(i, from, route, i == 0 ? begin : 0, last ? end : 0));
          from.heading_rad += legs.back().turn_rad(half_track_m);
        }
        all.push_back(std::move(legs));
      }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return effort_m(a) < effort_m(b); });
  if (all.size() > kMostStarts) all.resize(kMostStarts);
  return all;
}

void RefinedRun::join(std::size_t first, std::size_t count) {
  joint::JointQuery query{.start = first == 0 ? request_.start : request_.legs[first - 1].goal,
                          .checker = &run_.contexts[first].space->checker()};
  query.start.heading_rad = heading_before(first).value_or(parts_[first].leaves_rad);
  const std::vector<LegPath> present = paths();
  std::vector<Sketch> from_present;
  double found_J = 0;
  const double half_track_m = run_.contexts[first].world.robot.geometry.half_track_m;
  bool worth_it = false;
  for (std::size_t k = first; k < first + count; ++k) {
    const Path& path = present[k].path;
    from_present.push_back(joint::along_path(path, half_track_m, pieces_for(path)));
    worth_it = worth_it || turns_much(from_present.back(), path);
  }
  if (!worth_it) return;
  for (std::size_t k = first; k < first + count; ++k) {
    const ChoiceContext& context = run_.contexts[k];
    query.laws.push_back(law_of(k));
    if (!may_join(context.mission.legs[run_.first + k], query.laws.back().limits)) return;
    const Pose& goal = request_.legs[k].goal;
    const bool last = k + 1 == first + count;
    query.goals.push_back({{goal.x_m, goal.y_m}, last ? heading_after(k) : std::nullopt});
    found_J += certified_J(present[k].path, run_.first + k, context);
  }
  std::vector<std::vector<Sketch>> starts = rough_paths(first, query);
  starts.insert(starts.begin(), std::move(from_present));
  const std::vector<Part> before = parts_;
  std::vector<Part> best = parts_;
  for (const joint::JointPaths& joined : joint::best_joint_paths(query, std::move(starts))) {
    parts_ = before;
    double cost_J = 0;
    for (std::size_t i = 0; i < count; ++i) {
      take(first + i, joined.legs[i]);
      parts_[first + i].spline.reset();
    }
    const std::vector<LegPath> tried = paths();
    for (std::size_t k = first; k < first + count; ++k)
      cost_J += parts_[k].driving.drivable ? certified_J(tried[k].path, run_.first + k, run_.contexts[k])
                                           : kNoLimit;
    if (!(cost_J < found_J)) continue;
    found_J = cost_J;
    best = parts_;
  }
  parts_ = std::move(best);
}

void RefinedRun::join() {
  const std::size_t legs = parts_.size();
  for (std::size_t first = 0;; first += kMostTogether - 1) {
    const std::size_t count = std::min(kMostTogether, legs - first);
    join(first, count);
    if (first + count == legs) return;
  }
}

}  // namespace joulepath
