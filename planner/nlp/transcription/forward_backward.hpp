#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "planner/nlp/transcription/problem.hpp"

namespace joulepath::nlp {

/// Where and why no profile passes.
struct Blocked {
  std::size_t node{};
  std::string_view limit{};
  double needed{};   ///< least square of the rate that the rest of the path needs
  double allowed{};  ///< square of the rate that is possible at most
};

/// The fastest and the slowest profile on a grid.
struct RateEnvelope {
  std::vector<double> fastest{};  ///< squares of the rate
  std::vector<double> slowest{};
  std::optional<Blocked> blocked{};
};

/// Minimum time by passes over the grid: backward, the squares of the rate from which the end can be
/// reached under every row (an interval per node); forward, the largest (smallest) next square in it.
/// Rows that bend (voltage, power) are linearized at the last sweep's profile and swept again.
[[nodiscard]] RateEnvelope rate_envelope(const Problem& problem);

}  // namespace joulepath::nlp
