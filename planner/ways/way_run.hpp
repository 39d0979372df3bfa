#pragma once

#include <vector>

#include "planner/ways/leg_path.hpp"
#include "planner/ways/leg_ways.hpp"

namespace joulepath {

/// Consecutive legs between stations, to be chosen together.
struct WayRun {
  std::size_t first{};  ///< index of the first leg
  LegStart start{};
  std::vector<ChoiceContext> contexts{};  ///< one per leg: prices differ
  std::vector<LegRoutes> routes{};
  bool quick{};  ///< to learn prices: largest blends alone, no arcs at stops, no refinement
};

/// The paths of a run that cost least together, energy and time at the legs' prices. For each leg ways are
/// made over homotopically different routes: with corners driven as stop-turn-go or as blends of several
/// radii, and along headings that make turns at the stops needless. All are scored by inner profile solves
/// and listed in `alternatives`; dynamic programming over the stops picks one per leg, and `improvements`
/// lists what each step saved. Last, the control points of the chosen ways are moved. What collides is no
/// candidate. Empty where the run is empty or no choice can be driven.
[[nodiscard]] std::vector<LegPath> choose_run(const WayRun& run);

}  // namespace joulepath
