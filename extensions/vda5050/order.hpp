#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/path/geometry/nurbs.hpp"
#include "planner/values/mission_request.hpp"
#include "scenarios/text/schema.hpp"

namespace joulepath {

/// An action of a robot at a node or on an edge of an order.
struct OrderAction {
  /// none: the robot drives on, other actions may run; single: it drives on, no other action; soft: it
  /// stands, other actions may run; hard: it stands, no other action.
  enum class Blocking { none, single, soft, hard };
  std::string type{};
  Blocking blocking{Blocking::none};
  std::optional<double> duration_s{};  ///< the action parameter `duration`, if present
};

struct OrderNode {
  std::string id{};
  long sequence{};
  bool released{};
  double x_m{};
  double y_m{};
  std::optional<double> heading_rad{};
  double deviation_m{};  ///< allowed distance of the robot from the node; of an ellipse the smaller half-axis
  double deviation_rad{};  ///< of the heading
  std::vector<OrderAction> actions{};
  ItemMarks marks{};
};

struct OrderEdge {
  std::string id{};
  long sequence{};
  bool released{};
  std::optional<double> speed_m_s{};       ///< cap
  std::optional<double> yaw_rate_rad_s{};  ///< cap
  double orientation_rad{};
  bool orientation_is_global{};  ///< in the map; else against the path's tangent: 0 forward, pi in reverse
  std::optional<Nurbs> trajectory{};  ///< absent: straight
  std::vector<OrderAction> actions{};
  ItemMarks marks{};
};

/// A VDA 5050 order: nodes and edges alternately, edges[i] from nodes[i] to nodes[i + 1], ascending by
/// sequence. Released ones (the base) come first, the rest is the horizon.
struct Order {
  std::string file{};
  std::string id{};
  std::string version{};
  std::string map_id{};
  std::vector<OrderNode> nodes{};
  std::vector<OrderEdge> edges{};

  /// Nodes of the base.
  [[nodiscard]] std::size_t released_count() const;
};

/// The keys of an order that joulepath uses, VDA 5050 2.x and 3.x; other keys are accepted and unchanged.
[[nodiscard]] Schema order_schema();

/// Whether a document looks like an order: it has an order id, or nodes and edges.
[[nodiscard]] bool is_order(const Document& document);

/// Reads an order. An invalid order throws ConfigError; its key is a JSON pointer
/// (`/nodes/2/nodePosition/x`).
[[nodiscard]] Order read_order(const std::string& file, const NamedBy& named_by = {});

}  // namespace joulepath
