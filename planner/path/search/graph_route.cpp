#include "planner/path/search/graph_route.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <queue>

#include "model/limits.hpp"
#include "planner/path/search/polyline.hpp"

// Method: [Dijkstra1959]
namespace joulepath {
namespace {

constexpr std::size_t kEntryChoices = 4;

bool line_free(const std::vector<Point2>& line, const FootprintChecker& checker) {
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
    if (!checker.line_free(line[i][0], line[i][1], line[i + 1][0], line[i + 1][1])) return false;
  return true;
}

struct Access {
  std::size_t node{};
  double cost{};
};

/// Nodes next to a place, in a free straight line from it (or to it); nearest first.
std::vector<Access> accesses(const RouteGraph& graph, const Point2& place, bool from_place,
                             const FootprintChecker& checker, const TravelCost& cost) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < graph.nodes.size(); ++i)
    order.emplace_back(std::hypot(graph.nodes[i].x_m - place[0], graph.nodes[i].y_m - place[1]), i);
  std::sort(order.begin(), order.end());
  std::vector<Access> out;
  for (const auto& [distance, i] : order) {
    const Point2 node{graph.nodes[i].x_m, graph.nodes[i].y_m};
    const std::vector<Point2> line =
        from_place ? std::vector<Point2>{place, node} : std::vector<Point2>{node, place};
    if (!line_free(line, checker)) continue;
    out.push_back({i, polyline_cost(line, cost)});
    if (distance < kSamePlace_m || out.size() == kEntryChoices) break;
  }
  return out;
}

/// The cheapest chain of edges between two sets of nodes (Dijkstra); edge indices in order, and the cost.
struct Chain {
  double cost{kNoLimit};
  std::size_t first{}, last{};
  std::vector<std::size_t> edges{};
};

Chain cheapest_chain(const RouteGraph& graph, const std::vector<Access>& entries,
                     const std::vector<Access>& exits, const std::vector<double>& edge_cost) {
  constexpr auto kNone = static_cast<std::size_t>(-1);
  std::vector<double> cost(graph.nodes.size(), kNoLimit);
  std::vector<std::size_t> by_edge(graph.nodes.size(), kNone);
  std::vector<std::vector<std::size_t>> leaving(graph.nodes.size());
  for (std::size_t e = 0; e < graph.edges.size(); ++e) leaving[graph.edges[e].start].push_back(e);
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (const Access& entry : entries) cost[entry.node] = entry.cost, open.push({entry.cost, entry.node});
  while (!open.empty()) {
    const auto [c, node] = open.top();
    open.pop();
    if (c > cost[node]) continue;
    for (const std::size_t e : leaving[node]) {
      const std::size_t next = graph.edges[e].end;
      if (c + edge_cost[e] >= cost[next]) continue;
      cost[next] = c + edge_cost[e];
      by_edge[next] = e;
      open.push({cost[next], next});
    }
  }
  Chain chain;
  for (const Access& exit : exits)
    if (cost[exit.node] + exit.cost < chain.cost)
      chain.cost = cost[exit.node] + exit.cost, chain.last = exit.node;
  if (!std::isfinite(chain.cost)) return chain;
  chain.first = chain.last;
  while (by_edge[chain.first] != kNone) {
    chain.edges.push_back(by_edge[chain.first]);
    chain.first = graph.edges[by_edge[chain.first]].start;
  }
  std::reverse(chain.edges.begin(), chain.edges.end());
  return chain;
}

/// Drops repeated points and points on the straight line between their neighbors.
std::vector<Point2> tidy(const std::vector<Point2>& line) {
  std::vector<Point2> out;
  for (const Point2& p : line) {
    if (!out.empty() && std::hypot(p[0] - out.back()[0], p[1] - out.back()[1]) < kSamePlace_m) continue;
    while (out.size() >= 2) {
      const Point2 &a = out[out.size() - 2], &b = out.back();
      const double ux = b[0] - a[0], uy = b[1] - a[1], wx = p[0] - b[0], wy = p[1] - b[1];
      const bool straight = std::abs(ux * wy - uy * wx) < 1e-9 * std::hypot(ux, uy) * std::hypot(wx, wy) &&
                            ux * wx + uy * wy > 0;
      if (!straight) break;
      out.pop_back();
    }
    out.push_back(p);
  }
  return out;
}

}  // namespace

RouteResult plan_graph_route(const RouteSpace& space, const RouteRequest& request, const RouteGraph& graph) {
  RouteResult result;
  if (auto verdict = blocked_ends(space, request)) {
    result.verdict = *verdict;
    return result;
  }
  const Point2 start{request.start.x_m, request.start.y_m}, goal{request.goal_x_m, request.goal_y_m};
  std::vector<double> edge_cost;
  for (const RouteGraph::Edge& edge : graph.edges) {
    const std::vector<Point2> line = edge_line(graph, edge);
    edge_cost.push_back(line_free(line, space.checker()) ? polyline_cost(line, request.cost) : kNoLimit);
  }
  const Chain chain = cheapest_chain(graph, accesses(graph, start, true, space.checker(), request.cost),
                                     accesses(graph, goal, false, space.checker(), request.cost), edge_cost);
  if (!std::isfinite(chain.cost)) {
    char text[200];
    std::snprintf(text, sizeof text, "the route graph has no free way from (%.3f, %.3f) m to (%.3f, %.3f) m",
                  start[0], start[1], goal[0], goal[1]);
    result.verdict = {RouteStatus::no_connection, goal[0], goal[1], 0, false, std::nullopt, text};
    return result;
  }
  std::vector<Point2> line{start, {graph.nodes[chain.first].x_m, graph.nodes[chain.first].y_m}};
  for (const std::size_t e : chain.edges) {
    const std::vector<Point2> edge = edge_line(graph, graph.edges[e]);
    line.insert(line.end(), edge.begin(), edge.end());
  }
  line.push_back(goal);
  result = shape_route(space, request, tidy(line));
  result.searched_by = "route graph";
  return result;
}

}  // namespace joulepath
