#pragma once

#include "planner/motion/path_motion.hpp"
#include "planner/nlp/transcription/problem.hpp"
#include "planner/nlp/transcription/solution.hpp"
#include "planner/path/geometry/path_slopes.hpp"

// Design: docs/decisions/0211-whole-curves.md
// Method: [Fiacco1983]
namespace joulepath::nlp {

/// Derivatives of a problem's least cost by its path. By the envelope theorem they are the partial
/// derivatives of the Lagrangian at the solution, profile and multipliers kept: no further problem is solved.
/// Nodes keep their shares of the lengths between the mandatory nodes, and these stay at their material
/// points of the path, except where a wheel reverses. Borders of the floor's regions and memories of effects
/// are taken as fixed to the path. Requires a solution of the fast solver, which has the multipliers of the
/// caps.
[[nodiscard]] PathSlopes lagrangian_slopes(const Problem& problem, const PathMotion& motion,
                                           const Solution& solution, const std::vector<double>& mandatory);

}  // namespace joulepath::nlp
