#pragma once

#include "planner/ways/swing.hpp"

// Design: docs/decisions/0170-ways-as-whole-curves.md
namespace joulepath {

/// Two legs that meet at a stop with a free heading.
struct StopRequest {
  FreeSpline before{};
  FreeSpline after{};  ///< begins where `before` ends
  std::function<double(const Path& before, const Path& after)> cost{};
};
struct StopResult {
  SwingResult before{}, after{};
  double cost{};  ///< of both
};

/// Optimizes the common heading at the stop, the handles beside it and the knots next to it for the least
/// cost of both legs (Subplex). Absent where no free path was found.
[[nodiscard]] std::optional<StopResult> best_stop(const StopRequest& request, const FootprintChecker& checker,
                                                  const SearchEffort& effort = {});

}  // namespace joulepath
