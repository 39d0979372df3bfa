#include <algorithm>
#include <set>

#include "extensions/vda5050/order.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/robot_files/physical_bounds.hpp"
#include "scenarios/text/schema_text.hpp"

namespace joulepath {

namespace embedded {
extern const std::string_view vda5050_schemas;
}

namespace {

using Blocking = OrderAction::Blocking;

constexpr double kLongestAction_s = 86400;

std::optional<double> duration_of(const Node& action) {
  const auto parameters = action.find("actionParameters");
  if (!parameters) return std::nullopt;
  for (const Node& parameter : parameters->items()) {
    if (parameter["key"].text() != "duration") continue;
    const Node value = parameter["value"];
    const auto seconds = value.kind() == Value::Kind::scalar ? parse_number(value.text()) : std::nullopt;
    if (!seconds || *seconds < 0 || *seconds > kLongestAction_s)
      value.fail("a number of seconds from 0 to 86400");
    return seconds;
  }
  return std::nullopt;
}

std::vector<OrderAction> read_actions(const Node& node) {
  std::vector<OrderAction> actions;
  for (const Node& item : node.items()) {
    const std::string& word = item["blockingType"].text();
    actions.push_back({.type = item["actionType"].text(),
                       .blocking = word == "HARD"     ? Blocking::hard
                                   : word == "SOFT"   ? Blocking::soft
                                   : word == "SINGLE" ? Blocking::single
                                                      : Blocking::none,
                       .duration_s = duration_of(item)});
  }
  return actions;
}

double read_deviation(const Node& position) {
  const auto node = position.find("allowedDeviationXY");
  if (!node) return 0.0;
  if (node->kind() == Value::Kind::scalar) return node->number();
  return std::min((*node)["a"].number(), (*node)["b"].number());
}

OrderNode read_node(const Node& node) {
  const Node position = node["nodePosition"];
  return {.id = node["nodeId"].text(),
          .sequence = node["sequenceId"].integer(),
          .released = node["released"].boolean(),
          .x_m = position["x"].number(),
          .y_m = position["y"].number(),
          .heading_rad = position.optional_number("theta"),
          .deviation_m = read_deviation(position),
          .deviation_rad = position.number_or("allowedDeviationTheta", 0.0),
          .actions = read_actions(node["actions"]),
          .marks = marks_of(node)};
}

/// Knots of a clamped uniform curve, for a trajectory without knots.
std::vector<double> uniform_knots(std::size_t points, std::size_t degree) {
  std::vector<double> knots;
  for (std::size_t i = 0; i < points + degree + 1; ++i)
    knots.push_back(i <= degree ? 0.0 : static_cast<double>(std::min(i, points) - degree));
  return knots;
}

void check_knots(const Node& node, const Nurbs& nurbs) {
  const std::size_t points = nurbs.points.size(), wanted = points + nurbs.degree + 1;
  const std::vector<double>& u = nurbs.knots;
  if (u.size() != wanted)
    node.fail_found("a list of " + std::to_string(u.size()),
                    "a list of " + std::to_string(wanted) + ": control points + degree + 1");
  for (std::size_t i = 0; i + 1 < u.size(); ++i)
    if (u[i] > u[i + 1]) node.items()[i + 1].fail("a number >= the one before");
  for (std::size_t i = nurbs.degree + 1; i + nurbs.degree < points; ++i)
    if (u[i] == u[i + nurbs.degree])
      node.items()[i + nurbs.degree].fail("a knot at most `degree` times inside of the curve",
                                          "the curve would break there");
  if (!(u[nurbs.degree] < u[points])) node.fail("knots that are not all the same");
}

Nurbs read_trajectory(const Node& node) {
  Nurbs nurbs{.degree = static_cast<std::size_t>(node.number_or("degree", 1))};
  for (const Node& point : node["controlPoints"].items()) {
    const double weight = point.number_or("weight", 1.0);
    nurbs.points.push_back({weight * point["x"].number(), weight * point["y"].number(), weight});
  }
  if (nurbs.points.size() <= nurbs.degree)
    node["controlPoints"].fail("at least degree + 1 = " + std::to_string(nurbs.degree + 1) + " points");
  if (const auto knots = node.find("knotVector")) {
    for (const Node& knot : knots->items()) nurbs.knots.push_back(knot.number());
    check_knots(*knots, nurbs);
  } else {
    nurbs.knots = uniform_knots(nurbs.points.size(), nurbs.degree);
  }
  for (const RationalBezier& piece : bezier_pieces(nurbs))
    if (!(least_speed(piece) > 1e-6))
      node["controlPoints"].fail_found("a curve with a standstill or a cusp", "a trajectory without cusps",
                                       "control points that coincide are a frequent cause");
  return nurbs;
}

/// The smaller value of the two names that the versions of VDA 5050 use for one limit.
std::optional<double> lower_of(const Node& edge, const char* name, const char* other) {
  const auto one = edge.optional_number(name), two = edge.optional_number(other);
  return one && two ? std::min(*one, *two) : one ? one : two;
}

OrderEdge read_edge(const Node& node) {
  OrderEdge edge{.id = node["edgeId"].text(),
                 .sequence = node["sequenceId"].integer(),
                 .released = node["released"].boolean(),
                 .speed_m_s = lower_of(node, "maximumSpeed", "maxSpeed"),
                 .yaw_rate_rad_s = lower_of(node, "maximumRotationSpeed", "maxRotationSpeed"),
                 .orientation_rad = node.number_or("orientation", 0.0),
                 .orientation_is_global = node.text_or("orientationType", "TANGENTIAL") == "GLOBAL",
                 .actions = read_actions(node["actions"]),
                 .marks = marks_of(node)};
  if (const auto trajectory = node.find("trajectory")) edge.trajectory = read_trajectory(*trajectory);
  return edge;
}

/// Items of a list by their sequenceId.
std::vector<Node> sorted(const Node& list) {
  std::vector<Node> items = list.items();
  std::stable_sort(items.begin(), items.end(), [](const Node& a, const Node& b) {
    return a["sequenceId"].integer() < b["sequenceId"].integer();
  });
  return items;
}

void check_order(const Node& root, const std::vector<Node>& nodes, const std::vector<Node>& edges) {
  if (edges.size() + 1 != nodes.size())
    root["edges"].fail("one edge less than there are nodes, " + std::to_string(nodes.size() - 1));
  bool released = true;
  const auto base_comes_first = [&](const Node& item) {
    if (item["released"].boolean() && !released)
      item["released"].fail("false: the items before are not released", "the base comes before the horizon");
    released = item["released"].boolean();
  };
  const auto same = [](const Node& edge, const char* key, const Node& node) {
    const auto named = edge.find(key);
    const std::string& id = node["nodeId"].text();
    if (named && named->text() != id) named->fail(id + ", the neighbor by sequenceId");
  };
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    base_comes_first(nodes[i]);
    if (i == edges.size()) break;
    base_comes_first(edges[i]);
    const long from = nodes[i]["sequenceId"].integer(), to = nodes[i + 1]["sequenceId"].integer();
    const long between = edges[i]["sequenceId"].integer();
    if (!(from < between && between < to))
      edges[i]["sequenceId"].fail("a number between those of its nodes, " + std::to_string(from) + " and " +
                                  std::to_string(to));
    same(edges[i], "startNodeId", nodes[i]);
    same(edges[i], "endNodeId", nodes[i + 1]);
  }
  if (!nodes.front()["released"].boolean())
    nodes.front()["released"].fail("true: an order begins with its base");
}

Order order_from(const Document& document) {
  static const Schema schema = order_schema();
  const Node root = document.root();
  check_value(root, schema);
  Order order{.file = document.file(), .id = root.text_or("orderId", ""), .version = root["version"].text()};
  const auto is_version = [&](const char* start) { return order.version.rfind(start, 0) == 0; };
  if (!is_version("1.1") && !is_version("2.") && !is_version("3."))
    root["version"].fail("1.1, 2.x or 3.x", "the versions of VDA 5050 that are read");
  const std::vector<Node> nodes = sorted(root["nodes"]), edges = sorted(root["edges"]);
  check_order(root, nodes, edges);
  std::set<std::string> maps;
  for (const Node& node : nodes) {
    order.nodes.push_back(read_node(node));
    maps.insert(node["nodePosition"].text_or("mapId", ""));
    if (maps.size() > 1) node["nodePosition"]["mapId"].fail("one map for all nodes, " + *maps.begin());
  }
  order.map_id = *maps.begin();
  for (const Node& edge : edges) order.edges.push_back(read_edge(edge));
  return order;
}

}  // namespace

Schema order_schema() {
  return schema_in(embedded::vda5050_schemas, "order", true,
                   {{"coordinate", number({-kFarthest_m, kFarthest_m})},
                    {"degree", integer({1, RationalBezier::kMostDegree})}});
}

std::size_t Order::released_count() const {
  const auto end = std::find_if(nodes.begin(), nodes.end(), [](const auto& node) { return !node.released; });
  return static_cast<std::size_t>(end - nodes.begin());
}

bool is_order(const Document& document) {
  const Node root = document.root();
  return root.kind() == Value::Kind::map && (root.has("orderId") || (root.has("nodes") && root.has("edges")));
}

Order read_order(const std::string& file, const NamedBy& named_by) {
  return order_from(Document::load(file, named_by));
}

}  // namespace joulepath
