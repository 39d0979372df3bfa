#pragma once

#include <cstddef>
#include <vector>

#include "planner/ways/swing.hpp"

namespace joulepath {

/// A first guess for the optimizer.
struct SwingGuess {
  FreeSpline spline{};
  std::vector<std::size_t> moving{};  ///< knots that are polished
};

/// First guesses of a leg: one span with short and long handles, knots beside the start and the goal round
/// which the curve swings; or, along a given curve, its middle part joined to swings at both ends.
[[nodiscard]] std::vector<SwingGuess> swing_guesses(const SwingRequest& request);

}  // namespace joulepath
