#pragma once

#include "planner/ways/swing.hpp"

// Design: docs/decisions/0211-whole-curves.md
namespace joulepath {

/// Two legs that meet at a stop with a free heading, in the same one at first.
struct StopRequest {
  FreeSpline before{};
  FreeSpline after{};  ///< begins where `before` ends
  LegDrafts& drafts_before;
  LegDrafts& drafts_after;
};
struct StopResult {
  SwingResult before{}, after{};
  double cost{};  ///< of both
};

/// Optimizes the common heading at the stop, the handles and the knots of both legs for their least cost.
/// Absent where no free path was found.
[[nodiscard]] std::optional<StopResult> best_stop(const StopRequest& request,
                                                  const FootprintChecker& checker);

}  // namespace joulepath
