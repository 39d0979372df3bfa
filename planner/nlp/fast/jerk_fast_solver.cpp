#include "planner/nlp/fast/jerk_fast_solver.hpp"

#include <algorithm>
#include <cmath>

#include "planner/nlp/fast/jerk_newton.hpp"
#include "planner/nlp/fast/narrowing_kinks.hpp"
#include "planner/nlp/fast/newton_step.hpp"
// Design: docs/decisions/0302-jerk.md
// Method: [Mehrotra1992]
namespace joulepath::nlp {
namespace {

constexpr double kTolerance = 1e-9;  ///< relative to the objective: duality gap and residuals
constexpr double kDefectWeight = 0.1;
constexpr int kMostIterations = 150;
/// First complementarity of every pair, as a share of a segment's part of the objective.
constexpr double kFarGap = 0.1, kNearGap = 1e-2;

class JerkFastSolver {
 public:
  JerkFastSolver(const JerkProgram& program, double first_gap, double kink_width)
      : kinks_(program.problem(), kink_width),
        p_(kinks_.problem()),
        program_(program, p_),
        state_(rounded_start(first_gap)),
        newton_(program_, state_) {}

  JerkSolution solve() {
    JerkSolution solution;
    int& i = solution.iterations;
    for (; i < kMostIterations; ++i) {
      const double error = measure();
      if (!std::isfinite(error)) break;
      if (error <= kTolerance && kinks_.is_settled()) {
        solution.converged = true;
        break;
      }
      if (!iterate(error)) break;
    }
    if (!solution.converged)
      solution.message = i >= kMostIterations ? "no convergence within its iterations" : "no descent";
    solution.motion = program_.motion(state_.x);
    solution.objective = total_;
    solution.price_W = state_.multiplier_of_time();
    return solution;
  }

 private:
  JerkState rounded_start(double gap) {
    kinks_.start(program_.squares(), gap);
    return starting_state(program_, gap);
  }

  /// Residuals of the optimality conditions at the current point, relative to the objective.
  double measure() {
    double gap = 0, primal = 0, dual_z = 0, defect = 0;
    pairs_ = 0;
    state_.for_each_pair([&](const Pair& pair) { gap += pair.s * pair.y, ++pairs_; });
    mu_ = pairs_ > 0 ? gap / static_cast<double>(pairs_) : 0.0;
    for (RowSide& side : state_.sides) {
      side.residual =
          side.sign * (side.bound - state_.values[side.segment].rows[side.row].value) - side.pair.s;
      primal += std::abs(side.residual) * side.pair.y;
    }
    for (std::size_t k = 0; k < state_.lambda.size(); ++k)
      for (std::size_t i = 0; i < state_.lambda[k].size(); ++i) {
        const double value = state_.values[k].rows[program_.first_kinematic_row(k) + i].value;
        primal += std::abs(value * state_.lambda[k][i]);
        defect = std::max(defect, std::abs(value));
      }
    total_ = state_.objective;
    for (std::size_t i = 0; i < state_.recoveries.size(); ++i) {
      Recovery& r = state_.recoveries[i];
      const std::size_t k = i / state_.parts(), part = i % state_.parts();
      r.residual = state_.values[k].energy_J[part].value + r.z.s - r.sum.s;
      primal += std::abs(r.residual);
      total_ += p_.recovery_weight * r.z.s;
      dual_z += std::abs(p_.recovery_weight - r.z.y - r.sum.y) * r.z.s;
    }
    // The error of the gradient has a second-order effect; it stops falling once slacks reach rounding.
    const double worst = std::max({gap, kDualWeight * newton_.dual_error(), dual_z, primal});
    const double error = std::max(worst / std::max(1e-9, std::abs(total_)), kDefectWeight * defect);
    if (!state_.has_duration()) return error;
    const double slack_s = state_.has_budget() ? state_.time.s : 0.0;
    state_.time_residual = p_.duration_s - state_.duration_s - slack_s;
    return std::max(error, std::abs(state_.time_residual) / p_.duration_s);
  }

  /// Mehrotra's predictor and corrector; false if no step is left.
  bool iterate(double error) {
    newton_.assemble();
    state_.for_each_pair([](Pair& pair) { pair.corrected = 0; });
    const std::optional<StepSizes> affine = newton_.solve();
    if (!affine) return false;
    double after = 0;
    state_.for_each_pair([&](const Pair& pair) {
      after += (pair.s + affine->primal * pair.ds) * (pair.y + affine->dual * pair.dy);
    });
    const double ratio = pairs_ > 0 ? after / static_cast<double>(pairs_) / mu_ : 0.0;
    const double least =
        0.1 * kTolerance * std::max(1e-9, std::abs(total_)) / static_cast<double>(pairs_ + 1);
    const double target = std::max(least, mu_ * std::max(1e-4, ratio * ratio));
    const double trust = std::min(affine->primal, affine->dual);
    state_.for_each_pair([&](Pair& pair) {
      const double second = trust * trust * pair.ds * pair.dy, most = 10 * target + pair.s * pair.y;
      pair.corrected = target - std::clamp(second, -most, most);
    });
    const std::optional<StepSizes> sizes = newton_.solve();
    if (!sizes) return false;
    kinks_.narrow(error);
    newton_.take(*sizes);
    return sizes->primal > 1e-8;
  }

  NarrowingKinks kinks_;
  const Problem& p_;
  const JerkProgram program_;
  JerkState state_;
  JerkNewton newton_;
  std::size_t pairs_{};
  double total_{};  ///< objective, recovery included
  double mu_{};
};

}  // namespace

JerkSolution solve_fast(const JerkProgram& program, JerkStart start) {
  JerkSolution solution;
  int iterations = 0;
  for (const double width : kFinalWidths) {
    solution = JerkFastSolver(program, start == JerkStart::near ? kNearGap : kFarGap, width).solve();
    iterations += solution.iterations;
    if (solution.converged || !has_kinks(program.problem())) break;
  }
  solution.iterations = iterations;
  return solution;
}

}  // namespace joulepath::nlp
