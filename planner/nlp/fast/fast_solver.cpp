#include "planner/nlp/fast/fast_solver.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "planner/nlp/fast/coarse_problem.hpp"
#include "planner/nlp/fast/narrowing_kinks.hpp"
#include "planner/nlp/fast/thread_clock.hpp"
// Design: docs/decisions/0301-solvers.md
// Method: [Mehrotra1992]
namespace joulepath::nlp {
namespace {

/// Starts (see FastStart). Where the first gap is smaller, the first steps are short, and more iterations go
/// by than it saves.
constexpr double kColdGap = 0.3, kColdRoom = 1e-6;
/// From this many segments the start is solved for on a coarser grid, or iterations grow with the grid.
constexpr std::size_t kContinuedFrom = 800, kMerged = 8;
constexpr double kCoarseTolerance = 1e-2, kWarmGap = 1e-2, kWarmRoom = 1e-3;
constexpr int kCoarseIterations = 30;
/// A gradient stops falling where slacks reach rounding: a solve is at its end when nothing else is open and
/// its objective has stood still for this many iterations.
constexpr int kAtRest = 6;
constexpr double kMostRounding = 1e-5;  ///< of the weighted gradient, relative to the objective

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
  dual_residual_.reserve(nodes);
}

FastOutcome FastSolver::solve(const Problem& problem, const FastStart& start, const FastOptions& options,
                              NarrowingKinks* kinks) {
  p_ = &problem;
  kinks_ = kinks;
  tolerance_ = options.tolerance;
  if (kinks_) kinks_->start(start.b, start.gap);
  model_.set_problem(problem);
  set_starting_state(model_, start, state_);
  newton_.set_problem();
  dual_residual_.resize(problem.unknown_count());
  total_ = 0;
  at_rest_ = 0;
  for (iterations_ = 0; iterations_ < options.max_iterations; ++iterations_) {
    measure();
    if (!std::isfinite(error_)) return FastOutcome::no_descent;
    const bool settled = !kinks_ || kinks_->is_settled();
    if (settled && (error_ <= options.tolerance || at_rest_ >= kAtRest)) return FastOutcome::converged;
    if (std::isfinite(options.until_cpu_s) && thread_cpu_s() >= options.until_cpu_s)
      return FastOutcome::time_used;
    if (!iterate()) return FastOutcome::no_descent;
  }
  return FastOutcome::iterations_used;
}

/// Residuals of the optimality conditions at the current point, relative to the objective.
void FastSolver::measure() {
  const double total_before = total_;
  double gap = 0;
  pairs_ = 0;
  state_.for_each_pair([&](const Pair& pair) {
    gap += pair.s * pair.y;
    ++pairs_;
  });
  mu_ = gap / static_cast<double>(pairs_);  // of every unknown's lower bound at least
  double primal = 0;
  for (RowSide& side : state_.sides) {
    side.residual = side.sign * (side.bound - model_.row(side.row).value) - side.pair.s;
    primal += std::abs(side.residual) * side.pair.y;
  }
  total_ = model_.objective();
  double dual_z = 0;
  for (std::size_t i = 0; i < state_.recoveries.size(); ++i) {
    Recovery& r = state_.recoveries[i];
    const double E = model_.jets(i / p_->channels).energy_J[i % p_->channels].value;
    r.residual = E + r.z.s - r.sum.s;
    primal += std::abs(r.residual);
    total_ += p_->recovery_weight * r.z.s;
    dual_z += std::abs(p_->recovery_weight - r.z.y - r.sum.y) * r.z.s;
  }
  const double size = std::max(1e-9, std::abs(total_));
  double open = std::max({gap / size, dual_z / size, primal / size});
  if (state_.has_duration()) {
    state_.time_residual = p_->duration_s - model_.duration_s() - (state_.has_budget() ? state_.time.s : 0.0);
    open = std::max(open, std::abs(state_.time_residual) / p_->duration_s);
  }
  const double gradient = kDualWeight * dual_error() / size;  // it counts in second order
  error_ = std::max(open, gradient);
  const bool rests =
      open <= tolerance_ && gradient <= kMostRounding && std::abs(total_ - total_before) <= tolerance_ * size;
  at_rest_ = rests ? at_rest_ + 1 : 0;
}

/// Gradient of the Lagrangian, times b.
double FastSolver::dual_error() {
  std::fill(dual_residual_.begin(), dual_residual_.end(), 0.0);
  newton_.lagrangian_gradient(dual_residual_);
  double error = 0;
  for (std::size_t k = 0; k < dual_residual_.size(); ++k)
    error += std::abs(dual_residual_[k] - state_.low[k].y + state_.high[k].y) * state_.b[k + 1];
  return error;
}

/// Mehrotra's predictor and corrector; false where no step is left.
bool FastSolver::iterate() {
  if (!newton_.factor()) return false;
  state_.for_each_pair([](Pair& pair) { pair.corrected = 0; });
  const StepSizes affine = newton_.solve();
  double after = 0;
  state_.for_each_pair([&](const Pair& pair) {
    after += (pair.s + affine.primal * pair.ds) * (pair.y + affine.dual * pair.dy);
  });
  const double ratio = after / static_cast<double>(pairs_) / mu_;
  const double least = 0.1 * tolerance_ * std::max(1e-9, std::abs(total_)) / static_cast<double>(pairs_ + 1);
  const double target = std::max(least, mu_ * std::max(1e-4, ratio * ratio));
  const double trust = std::min(affine.primal, affine.dual);
  state_.for_each_pair([&](Pair& pair) {
    const double second = trust * trust * pair.ds * pair.dy, most = 10 * target + pair.s * pair.y;
    pair.corrected = target - std::clamp(second, -most, most);
  });
  const StepSizes sizes = newton_.solve();
  newton_.take(sizes);
  if (kinks_) kinks_->narrow(error_);
  model_.evaluate(state_.b);
  return sizes.primal > 1e-8;
}

void FastSolver::fill(Solution& solution) const {
  solution.b = state_.b;
  solution.objective = total_;
  solution.price_W = state_.multiplier_of_time();
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
