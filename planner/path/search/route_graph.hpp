#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/path/geometry/polygon_distance.hpp"

namespace joulepath {

/// A Nav2 route graph: places and directed edges between them, in the map frame.
struct RouteGraph {
  struct Node {
    long id{};
    double x_m{};
    double y_m{};
  };
  struct Edge {
    long id{};
    std::size_t start{};  ///< index into nodes
    std::size_t end{};
    std::optional<double> speed_limit_m_s{};
    std::vector<double> via_m{};                  ///< inner points of the edge's polyline: x, y, x, y ...
    std::optional<double> speed_limit_percent{};  ///< of the robot's greatest speed
  };
  std::vector<Node> nodes{};
  std::vector<Edge> edges{};
  std::string file{};
};

/// The polyline of an edge, from node to node.
[[nodiscard]] inline std::vector<Point2> edge_line(const RouteGraph& graph, const RouteGraph::Edge& edge) {
  std::vector<Point2> line{{graph.nodes[edge.start].x_m, graph.nodes[edge.start].y_m}};
  for (std::size_t i = 0; i + 1 < edge.via_m.size(); i += 2)
    line.push_back({edge.via_m[i], edge.via_m[i + 1]});
  line.push_back({graph.nodes[edge.end].x_m, graph.nodes[edge.end].y_m});
  return line;
}

}  // namespace joulepath
