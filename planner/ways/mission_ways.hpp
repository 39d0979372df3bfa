#pragma once

#include <optional>
#include <vector>

#include "planner/ways/way_run.hpp"

namespace joulepath {

/// The ways of a mission's legs, chosen at prices of a second. Routes that were searched are kept with the
/// space, so that asking again at other prices is cheap.
class MissionWays {
 public:
  MissionWays(const MissionRequest& mission, const MissionWorld& world, const RouteSpace* space,
              const Plant& plant, const PlanOptions& options)
      : mission_(mission), world_(world), space_(space), plant_(plant), options_(options) {}

  /// Paths of all legs, up to the first one that has none (its `infeasibility` has the reason). Consecutive
  /// legs between stations are chosen together; a prescribed motion has an empty path. A quick choice
  /// (WayRun::quick) is for learning prices. Throws ConfigError as leg_path() does.
  [[nodiscard]] std::vector<LegPath> choose(const std::vector<double>& price_W, bool quick) const;

 private:
  ChoiceContext context(double price_W) const {
    return {mission_, world_, space_, plant_, options_, price_W};
  }
  /// The routes of a leg between places; nothing where there is nothing to choose.
  std::optional<LegRoutes> routes_of(std::size_t leg, const LegStart& start, double price_W) const;
  LegPath settled(std::size_t leg, const LegStart& start) const;

  const MissionRequest& mission_;
  const MissionWorld& world_;
  const RouteSpace* space_;
  const Plant& plant_;
  const PlanOptions& options_;
};

}  // namespace joulepath
