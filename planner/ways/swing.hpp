#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "planner/path/floor/footprint_checker.hpp"
#include "planner/path/shape/free_spline.hpp"
#include "planner/path/shape/refine.hpp"

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
  std::size_t starts{3};             ///< first guesses that are polished
  int evaluations_per_variable{25};  ///< of the cost, per polished guess
  double relative_tolerance{1e-6};   ///< of the cost
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

/// Two legs that meet at a stop where any heading will do.
struct StopRequest {
  FreeSpline before{};
  FreeSpline after{};  ///< begins where `before` ends
  std::function<double(const Path& before, const Path& after)> cost{};
};
struct StopResult {
  SwingResult before{}, after{};
  double cost{};  ///< of both
};

/// Moves the common heading at the stop, the handles beside it and the knots next to it, so that the two legs
/// cost least together (Subplex). Absent where nothing free was found.
[[nodiscard]] std::optional<StopResult> best_stop(const StopRequest& request, const FootprintChecker& checker,
                                                  const SwingOptions& options = {});

}  // namespace joulepath
