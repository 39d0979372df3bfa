#pragma once

#include "planner/nlp/fast/newton_step.hpp"
#include "planner/nlp/transcription/problem.hpp"
#include "planner/nlp/transcription/solution.hpp"

namespace joulepath::nlp {

/// InteriorPoint for this structure: the Hessian is tridiagonal, every row and every recovery variable
/// belongs to one segment and is eliminated there, the duration row borders the system. One iteration costs
/// O(N).
///
/// Keeps its storage: after reserve(), or a problem of the same size, no memory is allocated.
class FastSolver {
 public:
  FastSolver() : newton_(model_, state_) {}
  FastSolver(const FastSolver&) = delete;
  FastSolver& operator=(const FastSolver&) = delete;

  void reserve(std::size_t nodes, std::size_t rows);

  /// The problem has to outlive the use of the state. `start`: all nodes, inside of the bounds. `kinks`, if
  /// given, belong to the problem and are narrowed with the iterations; without them kinks of the power stay
  /// sharp.
  FastOutcome solve(const Problem& problem, const FastStart& start, const FastOptions& options,
                    NarrowingKinks* kinks = nullptr);

  const FastState& state() const { return state_; }
  double error() const { return open_.error(); }  ///< gap and residuals, relative to the objective
  int iterations() const { return iterations_; }
  void fill(Solution& solution) const;

 private:
  const Problem* p_{};
  FastModel model_{};
  FastState state_{};
  NewtonStep newton_;
  OpenConditions open_{};
  int iterations_{};
};

/// Solves one problem, on a fine grid from a start that is solved for on a coarser one, whose iterations are
/// not counted. Where it stalls, `converged` is false and `message` says why. `b_guess`: all nodes, inside of
/// the bounds.
[[nodiscard]] Solution solve_fast(const Problem& problem, const std::vector<double>& b_guess,
                                  const FastOptions& options = {});

}  // namespace joulepath::nlp
