#pragma once

#include <vector>

#include "extensions/vda5050/order.hpp"
#include "planner/values/mission_request.hpp"

namespace joulepath {

/// The path along some edges of an order without a dwell.
struct OrderPath {
  Path path{};
  std::vector<PathPart> parts{};  ///< one per edge, in the path's arc length
};

/// Largest distance between a trajectory's end and its node that counts as rounding: the end is moved.
inline constexpr double kTrajectoryRounding_m = 0.01;

/// Drives edges `first` to `last` (not included) from a pose on nodes[first], and turns to the heading of
/// nodes[last] if it has one.
///
/// Trajectories are followed exactly, as rational curves. If two straight edges meet at a node with an
/// allowed deviation, the corner is a blend of continuous curvature within it; else the robot turns in place,
/// and stops where curvature jumps. Steps of heading up to 0.01 rad between trajectories are rounding: the
/// later one's second control point is rotated. Throws ConfigError for edges that cannot be driven.
[[nodiscard]] OrderPath order_path(const Order& order, std::size_t first, std::size_t last,
                                   const Pose& start);

/// The robot's heading at the beginning of an edge.
[[nodiscard]] double heading_into(const Order& order, std::size_t edge);

}  // namespace joulepath
