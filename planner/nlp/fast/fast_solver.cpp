#include "planner/nlp/fast/fast_solver.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "planner/nlp/fast/coarse_problem.hpp"
// Design: docs/decisions/0301-solvers.md
namespace joulepath::nlp {
namespace {

/// Starts (see FastStart). Where the first gap is smaller, the first steps are short, and more iterations go
/// by than it saves.
constexpr double kColdGap = 0.3, kColdRoom = 1e-6;
/// From this many segments the start is solved for on a coarser grid, or iterations grow with the grid.
constexpr std::size_t kContinuedFrom = 800, kMerged = 8;
constexpr double kCoarseTolerance = 1e-2, kWarmGap = 1e-2, kWarmRoom = 1e-3;
constexpr int kCoarseIterations = 30;

Solution solved(FastSolver& solver, NarrowingKinks& kinks, const FastStart& start,
                const FastOptions& options) {
  Solution solution;
  const FastOutcome outcome = solver.solve(kinks.problem(), start, options, &kinks);
  solution.converged = outcome == FastOutcome::converged;
  solution.iterations = solver.iterations();
  if (outcome == FastOutcome::iterations_used) solution.message = "no convergence within its iterations";
  if (outcome == FastOutcome::time_used) solution.message = "no convergence within its time";
  if (outcome == FastOutcome::no_descent) solution.message = "no descent";
  solver.fill(solution);
  return solution;
}

/// With wider kinks where the solver does not converge with narrow ones.
Solution solve_from(FastSolver& solver, const Problem& problem, const FastStart& start,
                    const FastOptions& options) {
  Solution solution;
  int iterations = 0;
  for (const double width : kFinalWidths) {
    NarrowingKinks kinks(problem, width);
    solution = solved(solver, kinks, start, options);
    iterations += solution.iterations;
    if (solution.converged || !has_kinks(problem)) break;
  }
  solution.iterations = iterations;
  return solution;
}

/// A rough optimum on fewer nodes, as a start for all of them: nothing where even that is not found, or where
/// kinks of curvature keep so many nodes that it would cost as much as the problem itself.
std::optional<std::vector<double>> start_from_coarse(const Problem& problem,
                                                     const std::vector<double>& b_guess) {
  const CoarseProblem coarse = coarsen(problem, kMerged);
  if (2 * coarse.problem.segment_count() > problem.segment_count()) return std::nullopt;
  const Solution near = solve_fast(coarse.problem, coarse.restricted(b_guess),
                                   {.tolerance = kCoarseTolerance, .max_iterations = kCoarseIterations});
  if (!near.converged) return std::nullopt;
  return coarse.prolonged(near.b, problem);
}

}  // namespace

void FastSolver::reserve(std::size_t nodes, std::size_t rows) {
  model_.reserve(nodes, rows);
  state_.reserve(nodes, rows);
  newton_.reserve(nodes);
}

FastOutcome FastSolver::solve(const Problem& problem, const FastStart& start, const FastOptions& options,
                              NarrowingKinks* kinks) {
  p_ = &problem;
  if (kinks) kinks->start(start.b, start.gap);
  model_.set_problem(problem);
  set_starting_state(model_, start, state_);
  newton_.set_problem();
  InteriorPoint<NewtonStep> loop(newton_, kinks);
  const FastOutcome outcome = loop.run(options);
  open_ = loop.open();
  iterations_ = loop.iterations();
  return outcome;
}

void FastSolver::fill(Solution& solution) const {
  solution.b = state_.b;
  solution.objective = open_.objective;
  solution.price_W = state_.time.multiplier();
  solution.row_multiplier.assign(p_->rows.size(), 0.0);
  for (const RowSide& side : state_.sides) solution.row_multiplier[side.row] += side.sign * side.pair.y;
  solution.cap_multiplier.assign(p_->node_count(), 0.0);
  for (std::size_t k = 0; k < state_.high.size(); ++k) solution.cap_multiplier[k + 1] = state_.high[k].y;
  for (const Recovery& recovery : state_.recoveries) {
    solution.z.push_back(recovery.z.s);
    solution.recovery_multiplier.push_back(recovery.sum.y);
  }
}

Solution solve_fast(const Problem& problem, const std::vector<double>& b_guess, const FastOptions& options) {
  FastSolver solver;
  if (problem.segment_count() >= kContinuedFrom) {
    const std::optional<std::vector<double>> near = start_from_coarse(problem, b_guess);
    if (near) {
      Solution solution = solve_from(solver, problem, {*near, kWarmGap, kWarmRoom, {}}, options);
      if (solution.converged) return solution;
    }
  }
  return solve_from(solver, problem, {b_guess, kColdGap, kColdRoom, {}}, options);
}

}  // namespace joulepath::nlp
