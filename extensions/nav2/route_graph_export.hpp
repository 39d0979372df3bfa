#pragma once

#include "extensions/nav2/graph_costs.hpp"
#include "scenarios/export/exports.hpp"

namespace joulepath {

struct RouteGraphOrder {
  std::string graph_file{};
  std::string out_file{};
  double payload_kg{};
  double corner_radius_m{};  ///< 0: the robot stops and turns in corners; else at least kLeastCornerRadius_m
  bool expand_turns{};
};

/// The graph file with `energy_J`, `abs_time_taken`, `abs_speed_limit` and `speed_limit` (percent) in the
/// metadata of each edge, and the settings of a route server for it (NAME.route_server.yaml). With
/// `expand_turns`, each node becomes one node per arriving edge, so that the costs of corners are exact.
struct RouteGraphExport {
  std::vector<ExportFile> files{};
  TurnAttribution attribution{};
  std::size_t nodes{}, edges{};  ///< of the written graph
  std::string arcs{};            ///< where the arcs at corners are smaller than asked for; else empty
  long goal_offset{};            ///< of an expanded graph: a route to node N ends at the node N + goal_offset
  std::vector<std::string> warnings{};
};

/// Throws ConfigError for a broken graph, or a robot that cannot drive it.
[[nodiscard]] RouteGraphExport export_route_graph(const RouteGraphOrder& order, const Robot& robot);

}  // namespace joulepath
