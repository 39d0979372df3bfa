#pragma once

#include "planner/nlp/terms/term.hpp"

namespace joulepath::nlp {

/// Time (s) that a segment takes, exact for constant acceleration: 2 ds/(u0 + u1). Summed over the
/// segments it is the row of the time budget; times watts it is the price of time in the objective.
struct Duration {
  static constexpr std::string_view name = "deadline";
  static constexpr std::size_t rows = 1;

  Bounds bounds(const Segment&, std::size_t) const { return {0.0, kNoLimit}; }
  template <class AnyInterval>
  auto operator()(const AnyInterval& interval, std::size_t) const {
    return interval.dt;
  }
};

}  // namespace joulepath::nlp
