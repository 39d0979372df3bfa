#pragma once

#include <vector>

#include "planner/nlp/transcription/problem.hpp"

namespace joulepath::nlp {

/// Fills `rows` and `first_row` of a problem whose segments, caps and ends are set: the rows of each segment
/// that its motion can bring to their bounds. `squares` is storage.
void select_rows(Problem& problem, const std::vector<Tightening>& tightenings, std::vector<double>& squares);

}  // namespace joulepath::nlp
