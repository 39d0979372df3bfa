#pragma once

#include "planner/nlp/fast/fast_state.hpp"
#include "planner/nlp/fast/tridiagonal.hpp"

namespace joulepath::nlp {

/// The Newton system of FastState. Every row and every recovery variable is eliminated within its segment,
/// what is left by b is tridiagonal, the duration borders it. O(N).
class NewtonStep {
 public:
  NewtonStep(FastModel& model, FastState& state) : model_(model), state_(state) {}

  /// Room for problems of this size.
  void reserve(std::size_t nodes);
  /// Takes the model's problem.
  void set_problem();

  const Problem& problem() const { return *p_; }
  FastState& state() { return state_; }
  double objective() const { return model_.objective(); }
  double duration_s() const { return model_.duration_s(); }
  std::size_t parts() const { return p_->channels; }
  const Jet& row(const RowSide& side) const { return model_.row(side.row); }
  const Jet& energy(std::size_t segment, std::size_t part) const {
    return model_.jets(segment).energy_J[part];
  }
  void add_equalities(double&, double&) const {}  // b follows its kinematics exactly
  [[nodiscard]] double dual_error();

  /// Assembles and factors at the state; shifted until positive definite, false where that fails.
  [[nodiscard]] bool factor();
  [[nodiscard]] std::optional<StepSizes> solve();
  void take(const StepSizes& sizes);
  void evaluate() { model_.evaluate(state_.b); }

 private:
  void lagrangian_gradient(std::vector<double>& to) const;
  void add_gradient(std::size_t segment, double g0, double g1, std::vector<double>& to) const;
  void add_hessian(std::size_t segment, double h00, double h01, double h11);
  void add_segments();
  void add_rows();
  bool factor_shifted();
  void right_side();
  void factor_border();
  void border();
  StepSizes expand();

  FastModel& model_;
  const Problem* p_{};
  FastState& state_;
  double new_price_{}, border_pivot_{};
  std::vector<double> gradient_{}, step_{}, time_gradient_{}, time_solved_{}, dual_residual_{};
  Tridiagonal hessian_{}, original_{};
};

}  // namespace joulepath::nlp
