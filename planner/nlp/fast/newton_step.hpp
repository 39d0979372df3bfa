#pragma once

#include "planner/nlp/fast/fast_state.hpp"
#include "planner/nlp/fast/tridiagonal.hpp"

namespace joulepath::nlp {

/// Weight of the dual residual in the error that ends an iteration: residuals of the stationarity conditions
/// are much larger numbers than the gap.
inline constexpr double kDualWeight = 1e-3;

/// Largest step lengths before a slack or a multiplier becomes zero.
struct StepSizes {
  double primal{1.0}, dual{1.0};

  /// Sets a pair's step, of which the dual part follows from the primal one.
  void move(Pair& pair, double ds) {
    pair.ds = ds;
    pair.dual_step();
    keep_positive(pair);
  }
  /// Sets the step of the duration's budget to a multiplier.
  void move_budget(Pair& time, double multiplier) {
    time.dy = multiplier - time.y;
    time.ds = (time.corrected - time.s * multiplier) / time.y;
    keep_positive(time);
  }
  /// Applies a pair's step.
  void take(Pair& pair) const {
    pair.s += primal * pair.ds;
    pair.y += dual * pair.dy;
  }

 private:
  void keep_positive(const Pair& pair) {
    constexpr double kToBoundary = 0.995;
    if (pair.s + primal * pair.ds < (1 - kToBoundary) * pair.s) primal = -kToBoundary * pair.s / pair.ds;
    if (pair.y + dual * pair.dy < (1 - kToBoundary) * pair.y) dual = -kToBoundary * pair.y / pair.dy;
  }
};

/// The Newton system of FastState. Every row and every recovery variable is eliminated within its segment,
/// what is left by b is tridiagonal, the duration borders it. O(N).
class NewtonStep {
 public:
  NewtonStep(const FastModel& model, FastState& state) : model_(model), state_(state) {}

  /// Room for problems of this size.
  void reserve(std::size_t nodes);
  /// Takes the model's problem.
  void set_problem();

  /// Assembles and factors at the state; shifted until positive definite, false where that fails.
  [[nodiscard]] bool factor();
  /// Steps of b and of every pair towards the complementarities wanted (Pair::corrected).
  StepSizes solve();
  /// Takes the last step.
  void take(const StepSizes& sizes);

  /// Gradient of the Lagrangian by b at the current multipliers, bounds left out.
  void lagrangian_gradient(std::vector<double>& to) const;

 private:
  void add_gradient(std::size_t segment, double g0, double g1, std::vector<double>& to) const;
  void add_hessian(std::size_t segment, double h00, double h01, double h11);
  void add_segments();
  void add_rows();
  bool factor_shifted();
  void right_side();
  void factor_border();
  void border();
  StepSizes expand();

  const FastModel& model_;
  const Problem* p_{};
  FastState& state_;
  double new_lambda_{}, border_pivot_{};
  std::vector<double> gradient_{}, step_{}, time_gradient_{}, time_solved_{};
  Tridiagonal hessian_{}, original_{};
};

}  // namespace joulepath::nlp
