#pragma once

#include <optional>
#include <vector>

#include "planner/path/floor/footprint_checker.hpp"
#include "planner/path/shape/free_spline.hpp"
#include "planner/ways/leg_drafts.hpp"

// Design: docs/decisions/0211-whole-curves.md
namespace joulepath {

/// A leg between two stops with a free path: the robot leaves in its present heading, turns while it drives,
/// and arrives in the requested heading, without a turn in place.
struct SwingRequest {
  Pose start{};
  Point2 goal_m{};
  std::optional<double> goal_heading_rad{};  ///< absent: any
  /// A free curve between the stops, whose middle part may be reused; absent: straight.
  const Curve* along{};
};

struct SwingResult {
  FreeSpline spline{};
  Path path{};
  double cost{};
};

/// The cheapest free splines found, in the order of their cost. Many first guesses (one to three spans with
/// short and long handles, knots beside the start and the goal, spans joined to the middle of `along`) are
/// each scored by one draft. The best of them follow the gradient of their cost over handles, knots and a
/// free goal heading; the better half of these do so again, with nodes placed anew. The results are free of
/// collisions along their whole length. Deterministic; empty where no free spline was found.
[[nodiscard]] std::vector<SwingResult> best_swings(const SwingRequest& request,
                                                   const FootprintChecker& checker, LegDrafts& drafts);

}  // namespace joulepath
