#include "extensions/nav2/route_graph_export.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "extensions/nav2/corner_table.hpp"
#include "extensions/nav2/foreign_graphs.hpp"
#include "extensions/nav2/route_graph_file.hpp"
#include "model/limit_table.hpp"
#include "model/text_of_list.hpp"
#include "planner/path/shape/corner_blend.hpp"
#include "scenarios/text/document.hpp"
#include "scenarios/text/quoted.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

/// Route servers store ids in 32 bits; new ids of an expanded graph follow the largest id.
constexpr long kMostId = 2'000'000'000;
constexpr long kMostRequestId = 65535;  ///< start_id and goal_id of its actions have 16 bits

bool is_line(const Json& feature) {
  const std::string type = feature["geometry"]["type"].get<std::string>();
  return type == "LineString" || type == "MultiLineString";
}

/// A number in floating-point notation: 12.0 instead of 12.
double as_float(double value) {
  constexpr double kDigits = 1e6;
  return std::round(value * kDigits) / kDigits;
}

Json metadata_of(const EdgeCost& cost, double most_m_s) {
  return {{"energy_J", std::max(1e-6, as_float(cost.energy_J))},
          {"abs_time_taken", std::max(1e-6, as_float(cost.time_s))},
          {"abs_speed_limit", as_float(cost.speed_m_s)},
          {"speed_limit", as_float(100 * std::min(1.0, cost.speed_m_s / most_m_s))}};
}

void add_metadata(Json& properties, const Json& more) {
  Json& metadata = properties["metadata"];
  if (!metadata.is_object()) metadata = Json::object();
  for (const auto& [key, value] : more.items()) metadata[key] = value;
}

/// Features of the file that are lines or points, in the order of the graph's edges or nodes.
std::vector<std::size_t> features_of(const Json& file, bool lines) {
  std::vector<std::size_t> features;
  for (std::size_t i = 0; i < file["features"].size(); ++i)
    if (is_line(file["features"][i]) == lines) features.push_back(i);
  return features;
}

/// What is added to a node's id for the goal there: a power of ten where the ids stay short enough.
long goal_offset(long largest) {
  long power = 10;
  while (power <= largest) power *= 10;
  return power + largest <= kMostRequestId ? power : largest + 1;
}

/// A node per arriving edge, in addition to the original nodes (routes start there) and a goal per original
/// node (routes end there). Edges that leave an arrival node include the cost of the corner; each leads to an
/// arrival node and to a goal.
class Expansion {
 public:
  Expansion(const Json& file, const RouteGraph& graph, const GraphCosts& costs, double most_m_s)
      : file_(file),
        graph_(graph),
        costs_(costs),
        most_m_s_(most_m_s),
        points_(features_of(file, false)),
        lines_(features_of(file, true)) {
    long largest = 0;
    for (const RouteGraph::Node& node : graph.nodes) largest = std::max(largest, node.id);
    offset_ = goal_offset(largest);
    next_id_ = offset_ + largest + 1;
  }

  long offset() const { return offset_; }
  long largest_goal() const { return largest_goal_; }

  Json write() {
    Json out = file_;
    out["features"] = Json::array();
    for (const std::size_t i : points_) out["features"].push_back(file_["features"][i]);
    std::vector<long> goal, arrival;
    for (std::size_t n = 0; n < graph_.nodes.size(); ++n) {
      goal.push_back(graph_.nodes[n].id + offset_);
      largest_goal_ = std::max(largest_goal_, goal.back());
      add_node(out, n, goal.back(), "goal_of", graph_.nodes[n].id);
    }
    for (const RouteGraph::Edge& edge : graph_.edges) {
      arrival.push_back(next_id_++);
      add_node(out, edge.end, arrival.back(), "arrival_by", edge.id);
    }
    const auto add = [&](std::size_t e, long from, const EdgeCost& cost) {
      add_edge(out, e, from, arrival[e], cost);
      add_edge(out, e, from, goal[graph_.edges[e].end], cost);
    };
    for (std::size_t e = 0; e < graph_.edges.size(); ++e)
      add(e, graph_.nodes[graph_.edges[e].start].id, costs_.edges[e]);
    for (const CornerCost& corner : costs_.corners) {
      EdgeCost cost = costs_.edges[corner.out];
      cost.energy_J += corner.energy_J;
      cost.time_s += corner.time_s;
      add(corner.out, arrival[corner.in], cost);
    }
    if (next_id_ > kMostId)
      throw ConfigError({{graph_.file, 1, 1},
                         "features",
                         "a graph that is too large",
                         "fewer edges, or no --expand-turns",
                         ""});
    return out;
  }

 private:
  /// A copy of a node, with its frame and its operations.
  void add_node(Json& out, std::size_t n, long id, const char* key, long of) {
    Json feature = file_["features"][points_[n]];
    feature["properties"]["id"] = id;
    add_metadata(feature["properties"], {{key, of}});
    out["features"].push_back(std::move(feature));
  }

  void add_edge(Json& out, std::size_t e, long from, long to, const EdgeCost& cost) {
    Json feature = file_["features"][lines_[e]];
    Json& properties = feature["properties"];
    properties["id"] = next_id_++;
    properties["startid"] = from;
    properties["endid"] = to;
    Json more = metadata_of(cost, most_m_s_);
    more["edge_of_graph"] = graph_.edges[e].id;
    add_metadata(properties, more);
    out["features"].push_back(std::move(feature));
  }

  const Json& file_;
  const RouteGraph& graph_;
  const GraphCosts& costs_;
  double most_m_s_{};
  std::vector<std::size_t> points_{}, lines_{};
  long next_id_{}, offset_{}, largest_goal_{};
};

/// Names of the operations at nodes and edges.
std::set<std::string> operations_of(const Json& file) {
  std::set<std::string> names;
  for (const Json& feature : file["features"]) {
    const auto operations = feature["properties"].find("operations");
    if (operations == feature["properties"].end() || !operations->is_structured()) continue;
    for (const Json& operation : *operations)
      if (operation.is_object() && operation.contains("type") && operation["type"].is_string())
        names.insert(operation["type"].get<std::string>());
  }
  return names;
}

/// A route server does not read the lines of edges. Returns the ids of those that were not straight.
std::set<std::string> straighten(RouteGraph& graph) {
  std::set<std::string> bent;
  for (RouteGraph::Edge& edge : graph.edges) {
    if (!edge.via_m.empty()) bent.insert(std::to_string(edge.id));
    edge.via_m.clear();
  }
  return bent;
}

/// What a route server does otherwise than this export expects.
std::vector<std::string> warnings_of(const Json& file, const RouteGraph& graph,
                                     const std::set<std::string>& foreign) {
  std::vector<std::string> warnings;
  if (!foreign.empty())
    warnings.push_back(
        "operations of the graph that the route server's settings do not load: " + text_of_list(foreign) +
        "; the server stops a route at the first one. Add each to operations: with its plugin");
  std::set<std::string> fixed;
  std::size_t edge = 0;
  for (const std::size_t i : features_of(file, true)) {
    const RouteGraph::Edge& at = graph.edges[edge++];
    const Json& properties = file["features"][i]["properties"];
    if (properties.contains("overridable") && properties["overridable"] == false)
      fixed.insert(std::to_string(at.id));
  }
  if (!fixed.empty())
    warnings.push_back(
        "edges with overridable: false, whose own cost the route server uses instead of energy_J: " +
        text_of_list(fixed));
  return warnings;
}

/// `triggers`: the graph has operations of the type TriggerEvent. `foreign`: operations with plugins that
/// only their author knows.
std::string server_yaml(const std::string& graph_file, double most_m_s, bool triggers,
                        const std::set<std::string>& foreign) {
  char most[32];
  std::snprintf(most, sizeof most, "%.6g", most_m_s);
  std::string text =
      "# Nav2 route server that takes the route of least energy. Settings that are not named keep their\n"
      "# defaults. DynamicEdgesScorer keeps closed edges closed. A speed_limit of 100 percent is " +
      std::string(most) +
      " m/s: the\n# controller's own greatest speed has to be that.\n"
      "route_server:\n"
      "  ros__parameters:\n"
      "    graph_filepath: " +
      Json(graph_file).dump() +
      "  # on the robot: where the file is there\n"
      "    edge_cost_functions: [\"PenaltyScorer\", \"DynamicEdgesScorer\"]\n"
      "    PenaltyScorer:\n"
      "      plugin: \"nav2_route::PenaltyScorer\"\n"
      "      penalty_tag: energy_J\n"
      "      weight: 1.0\n"
      "    DynamicEdgesScorer:\n"
      "      plugin: \"nav2_route::DynamicEdgesScorer\"\n";
  if (!foreign.empty()) text += "    # to be added, with their plugins: " + text_of_list(foreign) + "\n";
  std::vector<std::string> operations = {"AdjustSpeedLimit", "ReroutingService"};
  if (triggers) operations.push_back("TriggerEvent");
  text += "    operations: [" + text_of_list(operations, quoted) + "]\n";
  for (const std::string& name : operations)
    text += "    " + name + ":\n      plugin: \"nav2_route::" + name + "\"\n";
  return text;
}

void check_costs(const RouteGraph& graph, const std::vector<EdgeCost>& costs) {
  for (std::size_t e = 0; e < costs.size(); ++e)
    if (!std::isfinite(costs[e].energy_J) || !std::isfinite(costs[e].time_s))
      throw ConfigError({{graph.file, 1, 1},
                         "features",
                         "edge " + std::to_string(graph.edges[e].id) + ", which the robot cannot drive",
                         "limits that allow its corners",
                         ""});
}

void check_radius(double radius_m) {
  if (radius_m == 0 || radius_m >= kLeastCornerRadius_m) return;
  char found[32];
  std::snprintf(found, sizeof found, "%g m", radius_m);
  throw ConfigError({{"--corner-radius", 0, 0},
                     "",
                     found,
                     "0, or from 0.01 m on",
                     "0: the robot stops and turns in place"});
}

std::string arcs_told(const GraphCosts& costs, double radius_m) {
  constexpr double kSharp_rad = 2.3;  // arcs at sharper corners are rarely asked for
  if (radius_m == 0 || costs.fits_up_to_rad > kSharp_rad) return {};
  char text[200];
  std::snprintf(
      text, sizeof text,
      "arcs of %g m fit corners up to %.0f degrees on edges of %.3g m (median): sharper corners have "
      "the largest arcs that fit",
      radius_m, costs.fits_up_to_rad * 180 / std::numbers::pi, costs.typical_leg_m);
  return text;
}

}  // namespace

RouteGraphExport export_route_graph(const RouteGraphOrder& order, const Robot& robot) {
  check_radius(order.corner_radius_m);
  RouteGraph graph = read_route_graph(order.graph_file);
  const std::set<std::string> straightened = straighten(graph);
  if (graph.edges.empty())
    throw ConfigError(
        {{order.graph_file, 1, 1}, "features", "no lines", "at least one edge (LineString)", ""});
  const GraphCosts costs = graph_costs(graph, robot, order.payload_kg, order.corner_radius_m);
  check_costs(graph, costs.with_turns);
  double most_m_s = limits_for_payload(robot, order.payload_kg).speed_m_s;
  for (const EdgeCost& cost : costs.edges)
    if (!std::isfinite(most_m_s) || cost.speed_m_s > most_m_s) most_m_s = cost.speed_m_s;
  Json json = Json::parse(geojson_text(order.graph_file));
  std::set<std::string> foreign = operations_of(json);
  const bool triggers = foreign.erase("TriggerEvent") > 0;
  RouteGraphExport result{.attribution = order.expand_turns ? TurnAttribution{} : costs.attribution,
                          .arcs = arcs_told(costs, order.corner_radius_m),
                          .warnings = warnings_of(json, graph, foreign)};
  if (!straightened.empty())
    result.warnings.push_back(
        "edges whose lines have points beside their nodes: " + text_of_list(straightened) +
        "; the route server drives straight from node to node, and so do these costs");
  if (order.expand_turns) {
    Expansion expansion(json, graph, costs, most_m_s);
    json = expansion.write();
    result.goal_offset = expansion.offset();
    if (expansion.largest_goal() > kMostRequestId)
      result.warnings.push_back("ids of goals up to " + std::to_string(expansion.largest_goal()) +
                                ": start_id and goal_id of Nav2's actions hold at most 65535");
  } else {
    std::size_t edge = 0;
    for (const std::size_t i : features_of(json, true))
      add_metadata(json["features"][i]["properties"], metadata_of(costs.with_turns[edge++], most_m_s));
  }
  for (const Json& feature : json["features"]) ++(is_line(feature) ? result.edges : result.nodes);
  const std::filesystem::path out = std::filesystem::absolute(order.out_file).lexically_normal();
  result.files.push_back({order.out_file, json.dump(1) + "\n"});
  result.files.push_back(
      {std::filesystem::path(order.out_file).replace_extension(".route_server.yaml").string(),
       server_yaml(out.string(), most_m_s, triggers, foreign)});
  return result;
}

}  // namespace joulepath
