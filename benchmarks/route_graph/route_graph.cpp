// Routes of a Dijkstra search with the semantics of Nav2's route planner (costs of edges in single precision,
// independent of the edge before) on exported graphs. The joules of the routes are those of full plans from
// stop to stop.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <queue>
#include <random>
#include <stdexcept>

#include "extensions/nav2/route_graph_export.hpp"
#include "model/limit_table.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/profile/profile_solver.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::json;

constexpr unsigned kSeed = 7;
constexpr double kDrivenOn_rad = 0.13;  ///< kinks up to 7.5 degrees: the robot does not stop there

struct GraphNode {
  long id{};
  double x_m{}, y_m{};
};
struct GraphEdge {
  std::size_t from{}, to{};
  Json metadata{};
};
struct Graph {
  std::vector<GraphNode> nodes{};
  std::vector<GraphEdge> edges{};
  std::vector<std::vector<std::size_t>> leaving{};
  std::map<long, std::size_t> index{};
  std::map<long, long> goal_of{};  ///< by the original id; in expanded graphs
};

Graph read_graph(const std::string& text) {
  Graph graph;
  const Json json = Json::parse(text);
  for (const Json& feature : json["features"]) {
    const Json& properties = feature["properties"];
    if (feature["geometry"]["type"] != "Point") continue;
    graph.index[properties["id"]] = graph.nodes.size();
    const Json& at = feature["geometry"]["coordinates"];
    graph.nodes.push_back({properties["id"], at[0], at[1]});
    if (properties.contains("metadata") && properties["metadata"].contains("goal_of"))
      graph.goal_of[properties["metadata"]["goal_of"]] = properties["id"];
  }
  graph.leaving.resize(graph.nodes.size());
  for (const Json& feature : json["features"]) {
    const Json& properties = feature["properties"];
    if (feature["geometry"]["type"] == "Point") continue;
    const std::size_t from = graph.index.at(properties["startid"]), to = graph.index.at(properties["endid"]);
    graph.leaving[from].push_back(graph.edges.size());
    graph.edges.push_back({from, to, properties.value("metadata", Json::object())});
  }
  return graph;
}

float number(const Json& metadata, const char* key, float otherwise) {
  if (!metadata.contains(key)) return otherwise;
  if (!metadata[key].is_number_float()) throw std::runtime_error(std::string(key) + " is no float");
  return metadata[key].get<float>();
}

float length_m(const Graph& graph, const GraphEdge& edge) {
  const GraphNode &a = graph.nodes[edge.from], &b = graph.nodes[edge.to];
  return hypotf(static_cast<float>(b.x_m - a.x_m), static_cast<float>(b.y_m - a.y_m));
}

using Scorer = float (*)(const Graph&, const GraphEdge&);
float distance_score(const Graph& graph, const GraphEdge& edge) {
  return length_m(graph, edge) / number(edge.metadata, "speed_limit", 1.0F);
}
float time_score(const Graph& graph, const GraphEdge& edge) {
  const float time_s = number(edge.metadata, "abs_time_taken", 0.0F);
  if (time_s > 0) return time_s;
  const float speed = number(edge.metadata, "abs_speed_limit", 0.0F);
  return length_m(graph, edge) / (speed > 0 ? speed : 0.5F);
}
float energy_score(const Graph&, const GraphEdge& edge) { return number(edge.metadata, "energy_J", 0.0F); }

/// Places of the cheapest route; empty where there is none.
std::vector<GraphNode> route(const Graph& graph, Scorer score, std::size_t start, std::size_t goal) {
  std::vector<float> cost(graph.nodes.size(), INFINITY);
  std::vector<std::size_t> by(graph.nodes.size(), SIZE_MAX);
  std::priority_queue<std::pair<float, std::size_t>, std::vector<std::pair<float, std::size_t>>,
                      std::greater<>>
      open;
  cost[start] = 0;
  open.emplace(0.0F, start);
  while (!open.empty()) {
    const auto [c, node] = open.top();
    open.pop();
    if (c != cost[node]) continue;
    if (node == goal) break;
    for (const std::size_t e : graph.leaving[node]) {
      const float next = c + score(graph, graph.edges[e]);
      if (!(next < cost[graph.edges[e].to])) continue;
      cost[graph.edges[e].to] = next;
      by[graph.edges[e].to] = e;
      open.emplace(next, graph.edges[e].to);
    }
  }
  if (by[goal] == SIZE_MAX) return {};
  std::vector<GraphNode> places{graph.nodes[goal]};
  for (std::size_t at = goal; at != start; at = graph.edges[by[at]].from) {
    const GraphNode& from = graph.nodes[graph.edges[by[at]].from];
    if (std::hypot(from.x_m - places.back().x_m, from.y_m - places.back().y_m) > 1e-6) places.push_back(from);
  }
  std::reverse(places.begin(), places.end());
  return places;
}

/// Least energy of straight runs and turns from rest to rest; each is solved once.
class FullPlans {
 public:
  FullPlans(const Robot& robot, double payload_kg)
      : plant_(make_plant(robot)), limits_(limits_for_payload(robot, payload_kg)), payload_kg_(payload_kg) {}

  double energy_J(const std::vector<GraphNode>& places) {
    if (places.size() < 2) throw std::runtime_error("no route where the graph has one");
    double sum_J = 0, run_m = 0;
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
      run_m += std::hypot(places[i + 1].x_m - places[i].x_m, places[i + 1].y_m - places[i].y_m);
      const double angle = i + 2 < places.size() ? corner_rad(places, i + 1) : 0.0;
      if (i + 2 < places.size() && std::abs(angle) < kDrivenOn_rad) continue;
      sum_J += piece_J(straight_piece({}, run_m), run_m, 0);
      run_m = 0;
      if (i + 2 < places.size()) sum_J += piece_J(TurnInPlace{{}, angle}, 0, angle);
    }
    return sum_J;
  }

 private:
  static double corner_rad(const std::vector<GraphNode>& p, std::size_t i) {
    return wrapped_angle_rad(std::atan2(p[i + 1].y_m - p[i].y_m, p[i + 1].x_m - p[i].x_m) -
                             std::atan2(p[i].y_m - p[i - 1].y_m, p[i].x_m - p[i - 1].x_m));
  }

  double piece_J(const PathPiece& piece, double length, double angle) {
    const std::pair<long, long> key{std::lround(1e4 * length), std::lround(1e4 * angle)};
    const auto [at, fresh] = known_.try_emplace(key, 0.0);
    if (!fresh) return at->second;
    ProfileRequest request{.piece = piece,
                           .plant = plant_,
                           .limits = limits_,
                           .payload = {payload_kg_, payload_kg_},
                           .solver = SolverChoice::fast};
    const ProfileResult result = solve_profile(request);
    if (!result.profile) throw std::runtime_error("no profile");
    return at->second = energy_by_cause(path_motion(request), *result.profile).total_J();
  }

  Plant plant_;
  Limits limits_;
  double payload_kg_{};
  std::map<std::pair<long, long>, double> known_{};
};

struct Row {
  int pairs{}, different{};
  double distance_J{}, time_J{}, energy_J{}, expanded_J{};
  double most_saved_percent{}, most_lost_percent{};
  TurnAttribution turns{};
};

Row compare(const std::string& file, const Robot& robot, double payload_kg, int pairs) {
  const RouteGraphExport plain = export_route_graph({file, "x.geojson", payload_kg, 0, false}, robot);
  const RouteGraphExport expanded = export_route_graph({file, "x.geojson", payload_kg, 0, true}, robot);
  const Graph graph = read_graph(read_text_file(file)), by_edges = read_graph(plain.files[0].content);
  const Graph by_turns = read_graph(expanded.files[0].content);
  FullPlans plans(robot, payload_kg);
  std::mt19937 random(kSeed);
  Row row{.turns = plain.attribution};
  for (int tries = 0; row.pairs < pairs && tries < 20 * pairs; ++tries) {
    const std::size_t start = random() % graph.nodes.size(), goal = random() % graph.nodes.size();
    const auto shortest = route(graph, distance_score, start, goal);
    if (start == goal || shortest.empty()) continue;
    const double distance_J = plans.energy_J(shortest);
    const double energy_J = plans.energy_J(route(by_edges, energy_score, start, goal));
    const long goal_id = by_turns.goal_of.at(graph.nodes[goal].id);
    const double expanded_J = plans.energy_J(
        route(by_turns, energy_score, by_turns.index.at(graph.nodes[start].id), by_turns.index.at(goal_id)));
    ++row.pairs;
    row.distance_J += distance_J;
    row.time_J += plans.energy_J(route(graph, time_score, start, goal));
    row.energy_J += energy_J;
    row.expanded_J += expanded_J;
    row.different += std::abs(energy_J - distance_J) > 1e-6 * distance_J;
    row.most_saved_percent = std::max(row.most_saved_percent, 100 * (1 - energy_J / distance_J));
    row.most_lost_percent = std::max(row.most_lost_percent, 100 * (energy_J / distance_J - 1));
  }
  return row;
}

int run(const char* out, int pairs, const char* provenance) {
  std::string text =
      std::string("# Routes by energy on exported graphs\n\n") + provenance +
      "\n\nRobot: nomad_super_scout. Joules of the routes are planned in full: each straight run "
      "and each turn in place from rest to rest, standby included; kinks up to 7.5 degrees are "
      "driven through. DistanceScorer and TimeScorer see the graph as it was (no metadata, so "
      "both take the shortest route). PenaltyScorer sees the exported energy.\n\n"
      "| graph | payload kg | pairs | DistanceScorer J | TimeScorer J | energy on edges J (saves) | "
      "--expand-turns J (saves) | other route | most saved, most lost | a corner costs; edges miss "
      "it by rms, worst |\n|---|---|---|---|---|---|---|---|---|---|\n";
  const Robot robot = read_robot("scenarios/robots/nomad_super_scout.yaml");
  for (const char* graph : {"warehouse_graph", "depot_graph"})
    for (const double payload_kg : {0.0, 5.0, 10.0}) {
      const Row row = compare(std::string("scenarios/maps/") + graph + ".geojson", robot, payload_kg, pairs);
      char line[500];
      std::snprintf(
          line, sizeof line,
          "| %s | %g | %d | %.0f | %.0f | %.0f (%.2f %%) | %.0f (%.2f %%) | %.0f %% | %.1f, %.1f %% | "
          "%.2f; %.2f, %.2f J |\n",
          graph, payload_kg, row.pairs, row.distance_J, row.time_J, row.energy_J,
          100 * (1 - row.energy_J / row.distance_J), row.expanded_J,
          100 * (1 - row.expanded_J / row.distance_J), 100.0 * row.different / row.pairs,
          row.most_saved_percent, row.most_lost_percent, row.turns.mean_J, row.turns.rms_J,
          row.turns.worst_J);
      text += line;
      std::fputs(line, stderr);
    }
  std::ofstream(out) << text;
  return 0;
}

}  // namespace
}  // namespace joulepath

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: %s FILE PAIRS PROVENANCE\n", argv[0]);
    return 2;
  }
  return joulepath::run(argv[1], std::atoi(argv[2]), argv[3]);
}
