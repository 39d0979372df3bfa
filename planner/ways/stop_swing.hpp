#pragma once

#include "planner/ways/swing.hpp"

// Design: docs/decisions/0170-ways-as-whole-curves.md
namespace joulepath {

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
                                                  const SearchEffort& effort = {});

}  // namespace joulepath
