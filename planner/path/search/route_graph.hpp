#pragma once

#include <optional>
#include <string>
#include <vector>

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
    std::vector<double> via_m{};  ///< inner points of the edge's polyline: x, y, x, y ...
  };
  std::vector<Node> nodes{};
  std::vector<Edge> edges{};
  std::string file{};
};

}  // namespace joulepath
