#pragma once

#include "planner/leg_path.hpp"
#include "planner/leg_timing.hpp"
#include "planner/path/search.hpp"

namespace joulepath {

/// Everything that a choice among ways looks at.
struct ChoiceContext {
  const MissionRequest& mission;
  const MissionWorld& world;
  const RouteSpace* space{};
  const Plant& plant;
  const PlanOptions& options;
  double price_W{};  ///< of a second on this leg, on top of standby
};

/// Energy and time of a path driven at its best for a price of time.
struct PathScore {
  double energy_J{};  ///< standby included
  double duration_s{};
  bool drivable{};

  double cost_J(double price_W) const { return energy_J + price_W * duration_s; }
};
[[nodiscard]] PathScore score_path(const Path& path, const LegRequest& leg, std::size_t leg_index,
                                   const ChoiceContext& context);

/// Ways of one leg that pass the collision check, from one start; they do not depend on the price of time.
struct LegWays {
  struct Way {
    std::string name{};
    Path path{};
  };
  LegStart start{};
  std::string source{};
  std::vector<Way> ways{};
  std::optional<LegPath> settled{};  ///< set where there is nothing to choose: a given path, or no route
};
[[nodiscard]] LegWays leg_ways(const LegRequest& leg, std::size_t leg_index, const LegStart& start,
                               const ChoiceContext& context);

/// The way of a leg that costs least, energy and time at its price, among: homotopically different routes,
/// and at their corners stop-turn-go, blends of several radii, and the largest blend that is free. All of
/// them are scored by the exact inner profile solve and told in `alternatives`; what does not pass the
/// collision check is no candidate. A path given in the mission is taken as it is.
[[nodiscard]] LegPath choose_leg_path(const LegWays& ways, const LegRequest& leg, std::size_t leg_index,
                                      const ChoiceContext& context);

/// Energy rate of travel on a leg (J/m), for the search: friction, rolling, slope and floor patches at a
/// steady speed with this leg's payload, plus standby and the price of time over that speed.
[[nodiscard]] TravelCost energy_rate(const LegRequest& leg, const ChoiceContext& context);

}  // namespace joulepath
