#include "scenarios/export/route_graph.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "model/limit_table.hpp"
#include "planner/accounts/corner_table.hpp"
#include "scenarios/document.hpp"
#include "scenarios/mission_file.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

/// Route servers store ids in 32 bits; new ids of an expanded graph follow the largest id.
constexpr long kMostId = 2'000'000'000;
constexpr double kTransfer = 1e-3;  ///< J and s from an arrival node to its place: positive, but negligible

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

/// Line features of the file, in the order of the graph's edges.
std::vector<std::size_t> line_features(const Json& file) {
  std::vector<std::size_t> lines;
  for (std::size_t i = 0; i < file["features"].size(); ++i)
    if (is_line(file["features"][i])) lines.push_back(i);
  return lines;
}

/// A node per arriving edge, in addition to the original nodes (routes start there) and a copy of each
/// (routes end there). Edges that leave an arrival node include the cost of the corner.
class Expansion {
 public:
  Expansion(const Json& file, const RouteGraph& graph, const GraphCosts& costs, double most_m_s)
      : file_(file), graph_(graph), costs_(costs), most_m_s_(most_m_s), lines_(line_features(file)) {
    long largest = 0;
    for (const RouteGraph::Node& node : graph.nodes) largest = std::max(largest, node.id);
    for (const RouteGraph::Edge& edge : graph.edges) largest = std::max(largest, edge.id);
    next_id_ = largest + 1;
  }

  Json write() {
    Json out = file_;
    out["features"] = Json::array();
    for (const Json& feature : file_["features"])
      if (!is_line(feature)) out["features"].push_back(feature);
    std::vector<long> goal, arrival;
    for (const RouteGraph::Node& node : graph_.nodes) goal.push_back(add_node(out, node, "goal_of", node.id));
    for (const RouteGraph::Edge& edge : graph_.edges)
      arrival.push_back(add_node(out, graph_.nodes[edge.end], "arrival_by", edge.id));
    for (std::size_t e = 0; e < graph_.edges.size(); ++e) {
      const RouteGraph::Edge& edge = graph_.edges[e];
      add_edge(out, e, graph_.nodes[edge.start].id, arrival[e], costs_.edges[e]);
      add_transfer(out, graph_.nodes[edge.end], arrival[e], goal[edge.end]);
    }
    for (const CornerCost& corner : costs_.corners) {
      EdgeCost cost = costs_.edges[corner.out];
      cost.energy_J += corner.energy_J;
      cost.time_s += corner.time_s;
      add_edge(out, corner.out, arrival[corner.in], arrival[corner.out], cost);
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
  long add_node(Json& out, const RouteGraph::Node& at, const char* key, long of) {
    const long id = next_id_++;
    out["features"].push_back({{"type", "Feature"},
                               {"properties", {{"id", id}, {"metadata", {{key, of}}}}},
                               {"geometry", {{"type", "Point"}, {"coordinates", {at.x_m, at.y_m}}}}});
    return id;
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

  void add_transfer(Json& out, const RouteGraph::Node& at, long from, long to) {
    const Json point = {at.x_m, at.y_m};
    const EdgeCost nothing{kTransfer, kTransfer, most_m_s_};
    out["features"].push_back({{"type", "Feature"},
                               {"properties",
                                {{"id", next_id_++},
                                 {"startid", from},
                                 {"endid", to},
                                 {"metadata", metadata_of(nothing, most_m_s_)}}},
                               {"geometry", {{"type", "LineString"}, {"coordinates", {point, point}}}}});
  }

  const Json& file_;
  const RouteGraph& graph_;
  const GraphCosts& costs_;
  double most_m_s_{};
  std::vector<std::size_t> lines_{};
  long next_id_{};
};

std::string server_yaml(const std::string& graph_file) {
  return "# Nav2 route server that takes the route of least energy. Settings that are not named keep their\n"
         "# defaults. DynamicEdgesScorer keeps closed edges closed.\n"
         "route_server:\n"
         "  ros__parameters:\n"
         "    graph_filepath: " +
         graph_file +
         "\n"
         "    edge_cost_functions: [\"PenaltyScorer\", \"DynamicEdgesScorer\"]\n"
         "    PenaltyScorer:\n"
         "      plugin: \"nav2_route::PenaltyScorer\"\n"
         "      penalty_tag: energy_J\n"
         "      weight: 1.0\n"
         "    DynamicEdgesScorer:\n"
         "      plugin: \"nav2_route::DynamicEdgesScorer\"\n"
         "    operations: [\"AdjustSpeedLimit\"]\n"
         "    AdjustSpeedLimit:\n"
         "      plugin: \"nav2_route::AdjustSpeedLimit\"\n"
         "      speed_tag: speed_limit\n";
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
  const RouteGraph graph = read_route_graph(order.graph_file);
  if (graph.edges.empty())
    throw ConfigError(
        {{order.graph_file, 1, 1}, "features", "no lines", "at least one edge (LineString)", ""});
  const GraphCosts costs = graph_costs(graph, robot, order.payload_kg, order.corner_radius_m);
  check_costs(graph, costs.with_turns);
  double most_m_s = limits_for_payload(robot, order.payload_kg).speed_m_s;
  for (const EdgeCost& cost : costs.edges)
    if (!std::isfinite(most_m_s) || cost.speed_m_s > most_m_s) most_m_s = cost.speed_m_s;
  Json json = Json::parse(read_text_file(order.graph_file));
  if (order.expand_turns) {
    json = Expansion(json, graph, costs, most_m_s).write();
  } else {
    std::size_t edge = 0;
    for (const std::size_t i : line_features(json))
      add_metadata(json["features"][i]["properties"], metadata_of(costs.with_turns[edge++], most_m_s));
  }
  RouteGraphExport result{.attribution = order.expand_turns ? TurnAttribution{} : costs.attribution,
                          .arcs = arcs_told(costs, order.corner_radius_m)};
  for (const Json& feature : json["features"]) ++(is_line(feature) ? result.edges : result.nodes);
  const std::filesystem::path out(order.out_file);
  result.files.push_back({order.out_file, json.dump(1) + "\n"});
  result.files.push_back(
      {(out.parent_path() / "route_server.yaml").string(), server_yaml(out.filename().string())});
  return result;
}

}  // namespace joulepath
