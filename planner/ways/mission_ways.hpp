#pragma once

#include <optional>
#include <vector>

#include "planner/ways/dear_floor.hpp"
#include "planner/ways/way_run.hpp"

namespace joulepath {

/// The ways of a mission's legs, chosen at prices of a second. Searched routes are cached with the space, so
/// that another choice at other prices is cheap.
class MissionWays {
 public:
  MissionWays(const MissionRequest& mission, const MissionWorld& world, const RouteSpace* space,
              const Plant& plant, const PlanOptions& options)
      : mission_(mission),
        world_(world),
        space_(space),
        plant_(plant),
        options_(options),
        dear_(world, plant, space) {}

  /// Paths of all legs, up to the first leg without one (its `infeasibility` has the reason). Consecutive
  /// legs between stations are chosen together, up to a station that names a heading, because the legs after
  /// it do not depend on those before. A prescribed motion has an empty path. A quick choice (WayRun::quick)
  /// serves to find prices. Throws ConfigError as leg_path() does.
  [[nodiscard]] std::vector<LegPath> choose(const std::vector<double>& price_W, bool quick) const;

 private:
  /// Legs that are chosen together.
  struct Together {
    std::size_t first{};
    std::size_t count{};
    LegStart start{};
  };
  ChoiceContext context(double price_W, const RouteSpace* space) const {
    return {mission_, world_, space, plant_, options_, price_W};
  }
  /// True if a leg has more than one possible way.
  bool has_choice(std::size_t leg, const LegStart& start) const;
  const Station& stop_of(std::size_t leg) const { return mission_.stations.at(mission_.legs[leg].to); }
  /// Groups of legs from one leg on, up to the first leg without a choice.
  std::vector<Together> groups_from(std::size_t leg, LegStart start) const;
  /// The routes of a leg between places on a floor; may be empty.
  std::vector<PooledRoute> routes_of(std::size_t leg, const RouteRequest& request, double price_W,
                                     const RouteSpace& space) const;
  /// Paths of the legs, up to the first leg without a route; empty where no choice can be driven.
  std::vector<LegPath> choose_together(const Together& legs, const std::vector<double>& price_W,
                                       bool quick) const;
  /// The same on one floor.
  std::vector<LegPath> choose_on(const RouteSpace& space, const Together& legs,
                                 const std::vector<double>& price_W, bool quick) const;
  std::vector<LegPath> cheapest_detour(std::vector<LegPath> best, const Together& legs,
                                       const std::vector<double>& price_W, bool quick,
                                       const DearFloor::Parts& kept) const;
  /// Cost of the paths of legs; infinite where there are none.
  double cost_J(const Together& legs, const std::vector<LegPath>& paths,
                const std::vector<double>& price_W) const;
  LegPath settled(std::size_t leg, const LegStart& start) const;
  void tell_of_reverse(std::size_t leg, const LegStart& start, Infeasibility& reason) const;
  void check_direction(std::size_t leg) const;
  LegStart after(std::size_t leg, const LegPath& path, const LegStart& start) const;

  const MissionRequest& mission_;
  const MissionWorld& world_;
  const RouteSpace* space_;
  const Plant& plant_;
  const PlanOptions& options_;
  DearFloor dear_;
};

}  // namespace joulepath
