#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "planner/path/shape/free_spline.hpp"
#include "planner/path/shape/refine.hpp"
#include "planner/ways/spline_search.hpp"

// Design: docs/decisions/0170-ways-as-whole-curves.md
namespace joulepath {

/// A leg between two stops whose path is free: the robot leaves in the heading in which it stands, turns
/// while it drives, and arrives in the heading asked, without a turn in place.
struct SwingRequest {
  Pose start{};
  Point2 goal_m{};
  std::optional<double> goal_heading_rad{};  ///< absent: any
  const Curve* along{};  ///< a free curve between the stops, whose middle part may be kept; absent: straight
};

struct SwingOptions {
  std::size_t starts{3};  ///< first guesses that are polished
  SearchEffort effort{};  ///< per polished guess
};

struct SwingResult {
  FreeSpline spline{};
  Path path{};
  double cost{};
  int evaluations{};
};

/// The cheapest free spline that was found: many first guesses (one to three spans with short and long
/// handles, knots beside the start and the goal, joined to the middle of `along`) are judged by one
/// evaluation each, the best of them polished by NLopt's Subplex over handles, knots near the ends and a free
/// goal heading. The result is free of collisions along its whole length. Deterministic; absent where nothing
/// is free.
[[nodiscard]] std::optional<SwingResult> best_swing(const SwingRequest& request,
                                                    const FootprintChecker& checker, const PathCost& cost,
                                                    const SwingOptions& options = {});

}  // namespace joulepath
