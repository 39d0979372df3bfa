#include "extensions/nav2/graph_costs.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <map>
#include <numbers>

#include "extensions/nav2/corner_table.hpp"
#include "model/median.hpp"
#include "planner/legs/stretch.hpp"
#include "planner/motion/motion_energy.hpp"

// Method: [Brent1973]
namespace joulepath {
namespace {

constexpr double kStep_m = 0.25;  ///< sampling distance of the floor's properties
constexpr double kSlowest_m_s = 0.02;
constexpr int kBits = 14;  ///< of the cheapest speed
constexpr double kStraightBack_rad = 3.13;
constexpr double kLeast_J = 1e-3;  ///< a router needs positive costs
constexpr int kFitSweeps = 60;

class GraphPricer {
 public:
  GraphPricer(const RouteGraph& graph, const Robot& robot, double payload_kg, double corner_radius_m)
      : graph_(graph),
        plant_(make_plant(robot)),
        limits_(limits_along(robot, {payload_kg, payload_kg})),
        payload_kg_(payload_kg),
        leg_m_(typical_leg_m(graph)),
        corners_(plant_, limits_, payload_kg, corner_radius_m, leg_m_) {}

  GraphCosts price() const {
    GraphCosts costs{.typical_leg_m = leg_m_, .fits_up_to_rad = corners_.fits_up_to_rad()};
    for (const RouteGraph::Edge& edge : graph_.edges) costs.edges.push_back(edge_cost(edge));
    add_corners(costs, false);
    attribute(costs);
    add_corners(costs, true);
    return costs;
  }

 private:
  /// Median length of an edge: the typical distance between two corners.
  static double typical_leg_m(const RouteGraph& graph) {
    std::vector<double> lengths;
    for (const RouteGraph::Edge& edge : graph.edges) {
      const std::vector<Point2> line = edge_line(graph, edge);
      for (std::size_t i = 0; i + 1 < line.size(); ++i) lengths.push_back(distance_m(line[i], line[i + 1]));
    }
    if (lengths.empty()) return 5.0;
    return std::max(0.5, upper_median(std::move(lengths)));
  }

  /// Cost of an edge driven at constant speed along straight lines, with its corners.
  EdgeCost edge_cost(const RouteGraph::Edge& edge) const {
    const std::vector<Point2> line = edge_line(graph_, edge);
    const double share = edge.speed_limit_percent.value_or(100) / 100;
    const double most = std::min({share * limits_.speed_m_s, edge.speed_limit_m_s.value_or(kNoLimit), 10.0});
    const auto energy_J = [&](double speed_m_s) { return steady_J(line, speed_m_s); };
    EdgeCost cost{.speed_m_s = most};
    if (most > kSlowest_m_s)
      cost.speed_m_s = boost::math::tools::brent_find_minima(energy_J, kSlowest_m_s, most, kBits).first;
    if (energy_J(most) <= energy_J(cost.speed_m_s)) cost.speed_m_s = most;
    cost.energy_J = energy_J(cost.speed_m_s);
    for (std::size_t i = 0; i + 1 < line.size(); ++i)
      cost.time_s += distance_m(line[i], line[i + 1]) / cost.speed_m_s;
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
      const double angle = bearing_rad(line[i], line[i + 1]) - bearing_rad(line[i - 1], line[i]);
      const CornerTable::Cost corner = corners_.at(wrapped_angle_rad(angle));
      cost.energy_J += corner.energy_J;
      cost.time_s += corner.time_s;
    }
    cost.energy_J = std::max(kLeast_J, cost.energy_J);
    return cost;
  }

  double steady_J(const std::vector<Point2>& line, double speed_m_s) const {
    double sum_J = 0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const double length_m = distance_m(line[i], line[i + 1]);
      if (!(length_m > 0)) continue;
      const PathPiece piece =
          straight_piece({line[i][0], line[i][1], bearing_rad(line[i], line[i + 1])}, length_m);
      const PathMotion motion(piece, plant_, {payload_kg_, payload_kg_});
      const auto steps = static_cast<std::size_t>(std::ceil(length_m / kStep_m));
      std::vector<double> s, squares(steps + 1, speed_m_s * speed_m_s);
      for (std::size_t k = 0; k <= steps; ++k)
        s.push_back(length_m * static_cast<double>(k) / static_cast<double>(steps));
      sum_J += energy_by_cause(motion, profile_from_squares(s, squares)).total_J();
    }
    return sum_J;
  }

  /// Routes rarely lead straight back over another edge: costs on edges are not fitted to that.
  void add_corners(GraphCosts& costs, bool straight_back) const {
    std::vector<std::vector<std::size_t>> leaving(graph_.nodes.size());
    for (std::size_t e = 0; e < graph_.edges.size(); ++e) leaving[graph_.edges[e].start].push_back(e);
    for (std::size_t in = 0; in < graph_.edges.size(); ++in) {
      const std::vector<Point2> before = edge_line(graph_, graph_.edges[in]);
      const double arriving = bearing_rad(before[before.size() - 2], before.back());
      for (const std::size_t out : leaving[graph_.edges[in].end]) {
        const std::vector<Point2> behind = edge_line(graph_, graph_.edges[out]);
        if (graph_.edges[out].end == graph_.edges[in].start) continue;
        const double angle = wrapped_angle_rad(bearing_rad(behind[0], behind[1]) - arriving);
        const CornerTable::Cost corner = corners_.at(angle);
        if ((std::abs(angle) >= kStraightBack_rad) == straight_back)
          costs.corners.push_back({in, out, corner.energy_J, corner.time_s});
      }
    }
  }

  /// Attribution of corner costs to edges: the fit corner(in, out) = end of `in` + start of `out` of least
  /// squares over the corners, none below its floor. It iterates averages, each no lower than its floor:
  /// exact minimization over one half of the unknowns at a time, which converges under such bounds.
  void attribute(GraphCosts& costs) const {
    const std::size_t count = graph_.edges.size();
    std::vector<double> end_J(count, 0.0), start_J(count, 0.0), end_s(count, 0.0), start_s(count, 0.0);
    fit(costs, &CornerCost::energy_J, &EdgeCost::energy_J, end_J, start_J);
    fit(costs, &CornerCost::time_s, &EdgeCost::time_s, end_s, start_s);
    costs.with_turns = costs.edges;
    for (std::size_t e = 0; e < count; ++e) {
      EdgeCost& cost = costs.with_turns[e];
      cost.energy_J += start_J[e] + end_J[e];
      cost.time_s += start_s[e] + end_s[e];
    }
    TurnAttribution& result = costs.attribution;
    result.corners = costs.corners.size();
    if (costs.corners.empty()) return;
    double sum = 0, squares = 0;
    for (const CornerCost& corner : costs.corners) {
      const double left_over = corner.energy_J - end_J[corner.in] - start_J[corner.out];
      sum += corner.energy_J;
      squares += left_over * left_over;
      result.worst_J = std::max(result.worst_J, std::abs(left_over));
    }
    const auto corners = static_cast<double>(costs.corners.size());
    result.mean_J = sum / corners;
    result.rms_J = std::sqrt(squares / corners);
  }

  /// Least share of each edge's end (or start): 0, or half of the greatest saving of its corners, and never
  /// more than a quarter of the edge.
  static std::vector<double> floors(const GraphCosts& costs, std::size_t CornerCost::*at,
                                    double CornerCost::*cost, double EdgeCost::*whole) {
    std::vector<double> least(costs.edges.size(), 0.0);
    for (const CornerCost& corner : costs.corners)
      least[corner.*at] = std::min(least[corner.*at], 0.5 * corner.*cost);
    for (std::size_t e = 0; e < least.size(); ++e)
      least[e] = std::max(least[e], -0.25 * costs.edges[e].*whole);
    return least;
  }

  static void fit(const GraphCosts& costs, double CornerCost::*cost, double EdgeCost::*whole,
                  std::vector<double>& end, std::vector<double>& start) {
    const std::vector<double> least_end = floors(costs, &CornerCost::in, cost, whole);
    const std::vector<double> least_start = floors(costs, &CornerCost::out, cost, whole);
    std::vector<double> sum(end.size()), count(end.size());
    const auto sweep = [&](std::size_t CornerCost::*to, std::vector<double>& mine,
                           std::size_t CornerCost::*other, const std::vector<double>& theirs,
                           const std::vector<double>& least, double share) {
      std::fill(sum.begin(), sum.end(), 0.0);
      std::fill(count.begin(), count.end(), 0.0);
      for (const CornerCost& corner : costs.corners) {
        sum[corner.*to] += share * (corner.*cost - theirs[corner.*other]);
        count[corner.*to] += 1;
      }
      for (std::size_t e = 0; e < mine.size(); ++e)
        if (count[e] > 0) mine[e] = std::max(least[e], sum[e] / count[e]);
    };
    // Equal halves first: no edge gets the whole cost of a node.
    sweep(&CornerCost::in, end, &CornerCost::out, start, least_end, 0.5);
    for (int i = 0; i < kFitSweeps; ++i) {
      sweep(&CornerCost::out, start, &CornerCost::in, end, least_start, 1.0);
      sweep(&CornerCost::in, end, &CornerCost::out, start, least_end, 1.0);
    }
  }

  const RouteGraph& graph_;
  Plant plant_;
  Limits limits_;
  double payload_kg_{};
  double leg_m_{};
  CornerTable corners_;
};

}  // namespace

GraphCosts graph_costs(const RouteGraph& graph, const Robot& robot, double payload_kg,
                       double corner_radius_m) {
  return GraphPricer(graph, robot, payload_kg, corner_radius_m).price();
}

}  // namespace joulepath
