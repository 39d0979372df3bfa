#pragma once

#include "planner/nlp/transcription/jerk_program.hpp"
#include "planner/nlp/transcription/problem.hpp"
#include "planner/nlp/transcription/solution.hpp"

namespace joulepath::nlp {

struct IpoptOptions {
  double tolerance{1e-9};
  int max_iterations{300};
  bool warm{};             ///< the guess is nearly the solution
  const Solution* near{};  ///< with `warm`: multipliers to begin with, of a solution of the same Problem
};

/// Solves with Ipopt (interior point, MUMPS), exact sparse derivatives, no output. `b_guess`: all nodes.
[[nodiscard]] Solution solve_with_ipopt(const Problem& problem, const std::vector<double>& b_guess,
                                        const IpoptOptions& options = {});

/// The same with a jerk limit.
[[nodiscard]] JerkSolution solve_with_ipopt(const JerkProgram& program, const IpoptOptions& options = {});

}  // namespace joulepath::nlp
