#pragma once

#include <cstddef>
#include <vector>

#include "model/plant.hpp"
#include "planner/path/search/route_graph.hpp"

// Design: docs/decisions/0401-controllers-and-graphs.md
namespace joulepath {

/// Cost of one directed edge.
struct EdgeCost {
  double energy_J{};  ///< standby included; > 0
  double time_s{};
  double speed_m_s{};  ///< speed of least energy along the edge, standby included
};

/// Cost of a corner between two edges, in addition to driving both at their speeds: stop, turn and start, or
/// the slower arc. `in` and `out` are indices of edges; `out` starts where `in` ends.
struct CornerCost {
  std::size_t in{}, out{};
  double energy_J{}, time_s{};
};

/// Accuracy of the attribution of corner costs to edges.
struct TurnAttribution {
  std::size_t corners{};
  double mean_J{};  ///< mean cost of a corner
  double rms_J{};   ///< rms residual of the attribution at a corner
  double worst_J{};
};

/// Costs of a route graph for one robot with one payload.
struct GraphCosts {
  std::vector<EdgeCost> edges{};  ///< without the corners at their ends
  /// Each corner's cost split over its two edges. None costs less than in `edges`, but for half of what the
  /// corners at its ends save (arcs are shorter than their corners).
  std::vector<EdgeCost> with_turns{};
  std::vector<CornerCost> corners{};  ///< all pairs but those that lead back to the node before
  TurnAttribution attribution{};
  double typical_leg_m{};   ///< between two corners, on which these are planned
  double fits_up_to_rad{};  ///< greatest corner at which the arc as asked for fits such legs
};

/// `corner_radius_m`: radius of the arcs at corners, the largest that fits where that one is too long; 0: the
/// robot stops and turns.
[[nodiscard]] GraphCosts graph_costs(const RouteGraph& graph, const Robot& robot, double payload_kg,
                                     double corner_radius_m);

}  // namespace joulepath
