#include "planner/ways/way_run.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "planner/ways/way_chain.hpp"
#include "planner/ways/way_refinement.hpp"

namespace joulepath {
namespace {

constexpr double kWorthHalving_rad = 0.3;

/// Caches the turns in place that were checked.
class TurnCheck {
 public:
  explicit TurnCheck(const FootprintChecker& checker) : checker_(checker) {}

  bool operator()(const Pose& place, double from_rad, double to_rad) {
    if (checker_.is_disc()) return true;
    const double angle_rad = wrapped_angle_rad(to_rad - from_rad);
    if (std::abs(angle_rad) < 1e-9) return true;
    const auto [entry, fresh] = known_.try_emplace({place.x_m, place.y_m, from_rad, angle_rad});
    if (fresh)
      entry->second =
          !checker_.first_collision(PathPiece{TurnInPlace{{place.x_m, place.y_m, from_rad}, angle_rad}});
    return entry->second;
  }

 private:
  const FootprintChecker& checker_;
  std::map<std::array<double, 4>, bool> known_{};
};

/// A run with the ways created so far.
class RunChoice {
 public:
  explicit RunChoice(const WayRun& run)
      : run_(run),
        steps_(run.contexts.front().options.steps),
        may_turn_(run.contexts.front().space->checker()) {
    for (std::size_t k = 0; k < size(); ++k) {
      const double price_W = context(k).finite_price_W();
      auto& turns = turns_[price_W];
      if (!turns) turns = std::make_unique<TurnScores>(context(k));
      ways_.push_back(natural_ways(run.routes[k], leg(k), run.first + k, context(k), variety(k)));
      const LegRequest& asked = leg(k);
      const Station& stop = station(k);
      request_.legs.push_back({.price_W = price_W,
                               .start_payload_kg = asked.payload.from_kg,
                               .goal_payload_kg = asked.payload.to_kg,
                               .goal_heading_rad = stop.heading_rad,
                               .goal = {stop.x_m, stop.y_m, stop.heading_rad.value_or(0.0)},
                               .turns = turns.get()});
    }
    request_.start = run.start.pose;
    request_.start_heading_free = run.start.heading_free;
    request_.may_turn = [this](const Pose& place, double from_rad, double to_rad) {
      return may_turn_(place, from_rad, to_rad);
    };
    link();
  }

  std::vector<LegPath> choose();

 private:
  std::size_t size() const { return run_.routes.size(); }
  const ChoiceContext& context(std::size_t k) const { return run_.contexts[k]; }
  const LegRequest& leg(std::size_t k) const { return context(k).mission.legs[run_.first + k]; }
  const Station& station(std::size_t k) const { return context(k).mission.stations.at(leg(k).to); }
  const Way& way(std::size_t k, const std::vector<ChainChoice>& chain) const {
    return ways_[k][chain[k].way];
  }
  /// Creates only ways that a step needs; a quick choice uses the largest blends only.
  Variety variety(std::size_t k) const {
    Variety variety{.stop_turn_go = !run_.quick || !steps_.corners,
                    .blends = steps_.corners,
                    .radii = steps_.corners && !run_.quick};
    if (!steps_.routes) variety.route = shortest_route(run_.routes[k]);
    return variety;
  }
  void link() {
    for (std::size_t k = 0; k < size(); ++k) request_.legs[k].ways = &ways_[k];
  }

  std::vector<ChainChoice> choose_chain();
  std::vector<ChainChoice> ways_as_if_free();
  void add_bent_ways(const std::vector<ChainChoice>& natural);
  void note(const std::string& step, const std::vector<ChainChoice>& chain);
  std::vector<PathAlternative> alternatives(std::size_t k, const std::vector<ChainChoice>& chain) const;

  const WayRun& run_;
  WaySteps steps_;
  TurnCheck may_turn_;
  std::map<double, std::unique_ptr<TurnScores>> turns_{};
  std::vector<std::vector<Way>> ways_{};
  ChainRequest request_{};
  std::vector<std::vector<WayImprovement>> improvements_{};
};

/// Headings at the stops that could avoid a turn: those of stations, those of the neighboring legs, and the
/// mean between them.
void RunChoice::add_bent_ways(const std::vector<ChainChoice>& natural) {
  std::vector<std::vector<Way>> bent(size());
  for (std::size_t k = 0; k < size(); ++k) {
    std::vector<double> start_rad, goal_rad;
    const auto add_both = [](double mine_rad, double other_rad, std::vector<double>& headings) {
      headings.push_back(other_rad);
      const double between_rad = wrapped_angle_rad(other_rad - mine_rad);
      if (std::abs(between_rad) > kWorthHalving_rad) headings.push_back(mine_rad + 0.5 * between_rad);
    };
    const Way& mine = way(k, natural);
    if (k == 0 ? !run_.start.heading_free : station(k - 1).heading_rad.has_value())
      start_rad.push_back(k == 0 ? run_.start.pose.heading_rad : *station(k - 1).heading_rad);
    else if (k > 0)
      add_both(mine.leaves_rad, way(k - 1, natural).arrives_rad, start_rad);
    if (station(k).heading_rad)
      goal_rad.push_back(*station(k).heading_rad);
    else if (k + 1 < size())
      add_both(mine.arrives_rad, way(k + 1, natural).leaves_rad, goal_rad);
    bent[k] = bent_ways(ways_[k], start_rad, goal_rad, leg(k), run_.first + k, context(k));
  }
  for (std::size_t k = 0; k < size(); ++k)
    std::move(bent[k].begin(), bent[k].end(), std::back_inserter(ways_[k]));
  link();
}

void RunChoice::note(const std::string& step, const std::vector<ChainChoice>& chain) {
  improvements_.resize(size());
  for (std::size_t k = 0; k < chain.size(); ++k)
    improvements_[k].push_back({.step = step,
                                .energy_J = chain[k].score.energy_J,
                                .duration_s = chain[k].score.duration_s,
                                .cost_J = chain[k].score.cost_J(request_.legs[k].price_W)});
}

std::vector<PathAlternative> RunChoice::alternatives(std::size_t k,
                                                     const std::vector<ChainChoice>& chain) const {
  std::vector<PathAlternative> all;
  const std::vector<PathScore> scores = scores_between(request_, chain, k);
  for (std::size_t i = 0; i < scores.size(); ++i)
    all.push_back({.name = ways_[k][i].name,
                   .energy_J = scores[i].drivable ? scores[i].energy_J : kNoLimit,
                   .duration_s = scores[i].drivable ? scores[i].duration_s : kNoLimit,
                   .distance_m = ways_[k][i].path.distance_m(),
                   .chosen = i == chain[k].way});
  return all;
}

/// The way of each leg before refinement; empty where no way exists.
std::vector<ChainChoice> RunChoice::choose_chain() {
  std::vector<std::size_t> shortest;
  for (std::size_t k = 0; k < size(); ++k) shortest.push_back(shortest_route(run_.routes[k]));
  const auto plain = [&](std::size_t k, const Way& w) {
    return w.route == shortest[k] && (w.stops_at_corners || w.shape.corners.empty());
  };
  const auto with_corners = [&](std::size_t k, const Way& w) { return w.route == shortest[k]; };
  const auto any = [](std::size_t, const Way&) { return true; };
  const auto allowed = [&](std::size_t k, const Way& w) {
    const bool corners = steps_.corners || w.stops_at_corners || w.shape.corners.empty();
    return corners && (steps_.routes || w.route == shortest[k]);
  };

  if (!run_.quick) {
    note("shortest_route", cheapest_chain(request_, plain));
    note("corners", cheapest_chain(request_, with_corners));
  }
  std::vector<ChainChoice> chain = cheapest_chain(request_, allowed);
  note("routes", chain);
  if (chain.empty()) chain = cheapest_chain(request_, any);
  if (chain.empty()) return {};
  if (steps_.stops && !run_.quick) {
    add_bent_ways(chain);
    const auto bent_too = [&](std::size_t k, const Way& w) {
      return w.bends_at_ends ? steps_.routes || w.route == shortest[k] : allowed(k, w);
    };
    chain = cheapest_chain(request_, bent_too);
  }
  note("stops", chain);
  return chain;
}

/// Ways as if every turn could be driven, and routes where no way is free, for a run without a drivable
/// choice: the joint program may find one.
std::vector<ChainChoice> RunChoice::ways_as_if_free() {
  for (std::size_t k = 0; k < size(); ++k)
    if (ways_[k].empty() && !run_.routes[k].routes.empty())
      ways_[k].push_back(blocked_way(run_.routes[k], leg(k), run_.first + k, context(k)));
  link();
  ChainRequest free = request_;
  free.turns_count = false;
  std::vector<ChainChoice> chain = cheapest_chain(free, [](std::size_t, const Way&) { return true; });
  for (std::size_t k = chain.size(); k < size() && !ways_[k].empty(); ++k)
    chain.push_back({.score = ways_[k].front().score});
  return chain.size() == size() ? chain : std::vector<ChainChoice>{};
}

std::vector<LegPath> RunChoice::choose() {
  std::vector<ChainChoice> chain = choose_chain();
  if (chain.empty()) chain = ways_as_if_free();
  if (chain.empty()) return {};
  RefinedRun refined(request_, chain, run_);
  if (refined.barred() || (!run_.quick && steps_.refinement)) refined.join();
  if (refined.barred()) return {};
  std::vector<LegPath> paths = refined.paths();
  for (std::size_t k = 0; k < size(); ++k) {
    paths[k].source = run_.routes[k].routes[way(k, chain).route].searched_by;
    paths[k].alternatives = alternatives(k, chain);
    paths[k].improvements = improvements_[k];
    refined.tell(k, paths[k]);
  }
  return paths;
}

}  // namespace

std::vector<LegPath> choose_run(const WayRun& run) {
  if (run.routes.empty()) return {};
  return RunChoice(run).choose();
}

}  // namespace joulepath
