#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace joulepath {

/// A route graph of another program, in meters and in the map frame.
struct ForeignGraph {
  struct Node {
    std::string name{};
    double x_m{}, y_m{};
  };
  struct Edge {
    std::string name{};
    std::size_t start{}, end{};  ///< indices into nodes
    std::optional<double> speed_limit_m_s{};
  };
  std::vector<Node> nodes{};
  std::vector<Edge> edges{};
  std::vector<std::string> notes{};  ///< what was not read
};

}  // namespace joulepath
