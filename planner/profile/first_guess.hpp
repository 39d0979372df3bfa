#pragma once

#include <vector>

#include "planner/nlp/transcription/forward_backward.hpp"

namespace joulepath {

/// Squares of the rate between the slowest (share 0) and the fastest (1); the ends are kept.
[[nodiscard]] std::vector<double> blend(const nlp::RateEnvelope& envelope, double share);

/// A profile between the slowest and the fastest that takes about `duration_s`: squares of the rate.
[[nodiscard]] std::vector<double> first_guess(const nlp::Problem& problem, const nlp::RateEnvelope& envelope,
                                              double duration_s);

}  // namespace joulepath
