#pragma once

#include <cstddef>
#include <vector>

#include "planner/ways/swing.hpp"

namespace joulepath {

/// A first guess for the optimizer.
struct SwingGuess {
  FreeSpline spline{};
  std::vector<std::size_t> moving{};  ///< indices of the knots that are polished
};

/// First guesses of a leg: one span with short and long handles, and knots beside the start and the goal
/// around which the curve swings; with a given curve, also its middle part joined to swings at both ends.
[[nodiscard]] std::vector<SwingGuess> swing_guesses(const SwingRequest& request);

}  // namespace joulepath
