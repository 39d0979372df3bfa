// Costs of a route graph's edges and corners, by the laws of driving straight and turning.
#include "extensions/nav2/graph_costs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "extensions/nav2/corner_table.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// A corner takes what stopping and turning takes, not the way to it: 10 degrees far less than a straight
/// drive against friction, more for more degrees. The table is linear between every 5 degrees.
TEST(CornerTable, HasWhatTheCornerAddsAlone) {
  const Robot robot = testing::nomad();
  constexpr double kLeg_m = 4.0;
  const CornerTable table(make_plant(robot), *robot.limits, 0.0, 0.0, kLeg_m);
  const double friction_J = (robot.motor.left.friction_torque_Nm + robot.motor.right.friction_torque_Nm) /
                            robot.geometry.wheel_radius_m.left * 2 * kLeg_m;
  EXPECT_GT(table.at(10 * kDegree).energy_J, 0);
  EXPECT_LT(table.at(10 * kDegree).energy_J, friction_J);
  for (const double sign : {1.0, -1.0}) {
    const CornerTable::Cost low = table.at(sign * 90 * kDegree), high = table.at(sign * 95 * kDegree),
                            middle = table.at(sign * 92 * kDegree);
    EXPECT_GT(high.energy_J, low.energy_J);
    EXPECT_NEAR(middle.energy_J, 0.6 * low.energy_J + 0.4 * high.energy_J, 1e-9 * high.energy_J);
    EXPECT_NEAR(middle.time_s, 0.6 * low.time_s + 0.4 * high.time_s, 1e-9 * high.time_s);
  }
}

/// An edge of 8 m with inner points on its line and one of 3 m meet at a right angle, each at its own speed;
/// the corner is once more in the edges with turns.
TEST(GraphCosts, OfEdgesAreTheirLengthOverTheirSpeedAndTheCornersAreAttributed) {
  RouteGraph graph;
  graph.nodes = {{.id = 1}, {.id = 2, .x_m = 8}, {.id = 3, .x_m = 8, .y_m = 3}};
  graph.edges = {{.id = 10, .start = 0, .end = 1, .via_m = {2.0, 0, 3.8, 0, 5.0, 0, 5.9, 0, 6.7, 0, 7.3, 0}},
                 {.id = 11, .start = 1, .end = 2, .speed_limit_m_s = 0.2}};
  const GraphCosts costs = graph_costs(graph, testing::nomad(), 0, 0);
  ASSERT_EQ(costs.edges.size(), 2u);
  EXPECT_NEAR(costs.typical_leg_m, 1.2, 1e-9) << "the median, of the middle two the longer";
  EXPECT_NEAR(costs.edges[0].time_s, 8 / costs.edges[0].speed_m_s, 1e-9);
  EXPECT_NEAR(costs.edges[1].time_s, 3 / 0.2, 1e-3);
  ASSERT_EQ(costs.corners.size(), 1u);
  EXPECT_GT(costs.corners[0].time_s, 0);
  double apart_s = costs.corners[0].time_s, apart_J = costs.corners[0].energy_J, together_s = 0,
         together_J = 0;
  for (const EdgeCost& edge : costs.edges) apart_s += edge.time_s, apart_J += edge.energy_J;
  for (const EdgeCost& edge : costs.with_turns) together_s += edge.time_s, together_J += edge.energy_J;
  EXPECT_NEAR(together_s, apart_s, 1e-6 * apart_s);
  EXPECT_NEAR(together_J, apart_J, 1e-6 * apart_J);
}

}  // namespace
}  // namespace joulepath
