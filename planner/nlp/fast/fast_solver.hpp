#pragma once

#include "planner/nlp/transcription/problem.hpp"
#include "planner/nlp/transcription/solution.hpp"

namespace joulepath::nlp {

struct FastOptions {
  double tolerance{1e-9};  ///< relative to the objective: duality gap and residuals
  int max_iterations{80};
};

/// A primal-dual interior-point method made for this structure: the Hessian is tridiagonal, every row and
/// every recovery variable belongs to one segment and is eliminated there, the duration row borders the
/// system. Predictor-corrector steps; one iteration costs O(N). On a fine grid the start is solved for on a
/// coarser one, whose iterations are not counted. Where it stalls, `converged` is false and `message` says
/// why. `b_guess`: all nodes, inside of the bounds.
[[nodiscard]] Solution solve_fast(const Problem& problem, const std::vector<double>& b_guess,
                                  const FastOptions& options = {});

}  // namespace joulepath::nlp
