#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "planner/path/shape/free_spline.hpp"
#include "planner/path/shape/refine.hpp"
#include "planner/ways/spline_search.hpp"

// Design: docs/decisions/0170-ways-as-whole-curves.md, docs/decisions/0461-five-guesses-are-polished.md
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

struct SwingOptions {
  std::size_t starts{5};  ///< number of first guesses that are polished
  SearchEffort effort{};  ///< per polished guess
};

struct SwingResult {
  FreeSpline spline{};
  Path path{};
  double cost{};
  int evaluations{};
};

/// The cheapest free spline found. Many first guesses (one to three spans with short and long handles, knots
/// beside the start and the goal, spans joined to the middle of `along`) are each scored by one evaluation.
/// NLopt's Subplex polishes the best of them over handles, knots near the ends and a free goal heading. The
/// result is free of collisions along its whole length. Deterministic; absent where no free spline was found.
[[nodiscard]] std::optional<SwingResult> best_swing(const SwingRequest& request,
                                                    const FootprintChecker& checker, const PathCost& cost,
                                                    const SwingOptions& options = {});

}  // namespace joulepath
