#pragma once

#include <vector>

#include "planner/ways/leg_path.hpp"
#include "planner/ways/leg_ways.hpp"

namespace joulepath {

/// Consecutive legs between stations, to be chosen together.
struct WayRun {
  std::size_t first{};  ///< index of the first leg
  LegStart start{};
  std::vector<ChoiceContext> contexts{};  ///< one per leg, because prices differ
  std::vector<LegRoutes> routes{};
  bool quick{};  ///< for finding prices: largest blends only, no arcs at stops, no refinement
};

/// The paths of a run with the least total cost, energy and time at the legs' prices. For each leg, ways are
/// created over homotopically different routes: with corners as stop-turn-go or as blends of several radii,
/// and along headings that avoid turns at the stops. Inner profile solves score all of them (`alternatives`).
/// Dynamic programming over the stops picks one per leg, and `improvements` lists the saving of each step.
/// Finally the control points of the chosen ways are optimized. Ways with collisions are excluded. Empty
/// where the run is empty or no choice can be driven.
[[nodiscard]] std::vector<LegPath> choose_run(const WayRun& run);

}  // namespace joulepath
