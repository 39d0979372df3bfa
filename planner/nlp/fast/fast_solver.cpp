#include "planner/nlp/fast/fast_solver.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "planner/nlp/fast/coarse_problem.hpp"
#include "planner/nlp/fast/narrowing_kinks.hpp"
#include "planner/nlp/fast/newton_step.hpp"
// Design: docs/decisions/0051-fast-solver.md
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

class FastSolver {
 public:
  FastSolver(const Problem& problem, const FastStart& start, double kink_width)
      : kinks_(problem, kink_width),
        p_(kinks_.problem()),
        model_(p_),
        state_(rounded_start(start)),
        newton_(model_, state_),
        dual_residual_(problem.unknown_count()) {}

  Solution solve(const FastOptions& options) {
    tolerance_ = options.tolerance;
    Solution solution;
    int& i = solution.iterations;
    for (; i < options.max_iterations; ++i) {
      measure();
      if (!std::isfinite(error_)) break;
      if (kinks_.is_settled() && (error_ <= options.tolerance || at_rest_ >= kAtRest)) {
        solution.converged = true;
        break;
      }
      if (!iterate()) break;
    }
    if (!solution.converged)
      solution.message = i >= options.max_iterations ? "no convergence within its iterations" : "no descent";
    fill(solution);
    return solution;
  }

 private:
  FastState rounded_start(const FastStart& start) {
    kinks_.start(start.b, start.gap);
    return starting_state(model_, start);
  }

  /// Residuals of the optimality conditions at the current point, relative to the objective.
  void measure() {
    const double total_before = total_;
    double gap = 0;
    pairs_ = 0;
    state_.for_each_pair([&](const Pair& pair) {
      gap += pair.s * pair.y;
      ++pairs_;
    });
    mu_ = pairs_ > 0 ? gap / static_cast<double>(pairs_) : 0.0;
    double primal = 0;
    for (RowSide& side : state_.sides) {
      side.residual = side.sign * (side.bound - model_.row(side.row).value) - side.pair.s;
      primal += std::abs(side.residual) * side.pair.y;
    }
    total_ = model_.objective();
    double dual_z = 0;
    for (std::size_t i = 0; i < state_.recoveries.size(); ++i) {
      Recovery& r = state_.recoveries[i];
      const double E = model_.jets(i / p_.channels).energy_J[i % p_.channels].value;
      r.residual = E + r.z.s - r.sum.s;
      primal += std::abs(r.residual);
      total_ += p_.recovery_weight * r.z.s;
      dual_z += std::abs(p_.recovery_weight - r.z.y - r.sum.y) * r.z.s;
    }
    const double size = std::max(1e-9, std::abs(total_));
    double open = std::max({gap / size, dual_z / size, primal / size});
    if (state_.has_duration()) {
      state_.time_residual =
          p_.duration_s - model_.duration_s() - (state_.has_budget() ? state_.time.s : 0.0);
      open = std::max(open, std::abs(state_.time_residual) / p_.duration_s);
    }
    const double gradient = kDualWeight * dual_error() / size;  // it counts in second order
    error_ = std::max(open, gradient);
    const bool rests = open <= tolerance_ && gradient <= kMostRounding &&
                       std::abs(total_ - total_before) <= tolerance_ * size;
    at_rest_ = rests ? at_rest_ + 1 : 0;
  }

  /// Gradient of the Lagrangian, times b.
  double dual_error() {
    std::fill(dual_residual_.begin(), dual_residual_.end(), 0.0);
    newton_.lagrangian_gradient(dual_residual_);
    double error = 0;
    for (std::size_t k = 0; k < dual_residual_.size(); ++k)
      error += std::abs(dual_residual_[k] - state_.low[k].y + state_.high[k].y) * state_.b[k + 1];
    return error;
  }

  /// Mehrotra's predictor and corrector; false where no step is left.
  bool iterate() {
    if (!newton_.factor()) return false;
    state_.for_each_pair([](Pair& pair) { pair.corrected = 0; });
    const StepSizes affine = newton_.solve();
    double after = 0;
    state_.for_each_pair([&](const Pair& pair) {
      after += (pair.s + affine.primal * pair.ds) * (pair.y + affine.dual * pair.dy);
    });
    const double ratio = pairs_ > 0 ? after / static_cast<double>(pairs_) / mu_ : 0.0;
    const double least =
        0.1 * tolerance_ * std::max(1e-9, std::abs(total_)) / static_cast<double>(pairs_ + 1);
    const double target = std::max(least, mu_ * std::max(1e-4, ratio * ratio));
    const double trust = std::min(affine.primal, affine.dual);
    state_.for_each_pair([&](Pair& pair) {
      const double second = trust * trust * pair.ds * pair.dy, most = 10 * target + pair.s * pair.y;
      pair.corrected = target - std::clamp(second, -most, most);
    });
    const StepSizes sizes = newton_.solve();
    newton_.take(sizes);
    kinks_.narrow(error_);
    model_.evaluate(state_.b);
    return sizes.primal > 1e-8;
  }

  void fill(Solution& solution) const {
    solution.b = state_.b;
    solution.objective = total_;
    solution.price_W = state_.multiplier_of_time();
    solution.row_multiplier.assign(p_.rows.size(), 0.0);
    for (const RowSide& side : state_.sides) solution.row_multiplier[side.row] += side.sign * side.pair.y;
    for (const Recovery& recovery : state_.recoveries) {
      solution.z.push_back(recovery.z.s);
      solution.recovery_multiplier.push_back(recovery.sum.y);
    }
  }

  NarrowingKinks kinks_;
  const Problem& p_;
  FastModel model_;
  FastState state_;
  NewtonStep newton_;
  std::vector<double> dual_residual_;
  std::size_t pairs_{};
  double total_{};  ///< objective, recovery included
  double mu_{}, error_{}, tolerance_{};
  int at_rest_{};  ///< iterations that changed nothing but the rounding of the gradient
};

/// With wider kinks where the solver does not converge with narrow ones.
Solution solve_from(const Problem& problem, const FastStart& start, const FastOptions& options) {
  Solution solution;
  int iterations = 0;
  for (const double width : kFinalWidths) {
    solution = FastSolver(problem, start, width).solve(options);
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

Solution solve_fast(const Problem& problem, const std::vector<double>& b_guess, const FastOptions& options) {
  if (problem.segment_count() >= kContinuedFrom) {
    const std::optional<std::vector<double>> near = start_from_coarse(problem, b_guess);
    if (near) {
      Solution solution = solve_from(problem, {*near, kWarmGap, kWarmRoom}, options);
      if (solution.converged) return solution;
    }
  }
  return solve_from(problem, {b_guess, kColdGap, kColdRoom}, options);
}

}  // namespace joulepath::nlp
