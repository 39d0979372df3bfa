#pragma once

#include <optional>

#include "planner/nlp/fast/jerk_state.hpp"
#include "planner/nlp/fast/newton_step.hpp"
#include "planner/nlp/fast/stage_system.hpp"

namespace joulepath::nlp {

/// The Newton system of JerkState: NewtonStep for a program with a jerk limit. Rows and recoveries are
/// eliminated within their segment; the remaining system is solved from segment to segment. O(N).
class JerkNewton {
 public:
  JerkNewton(const JerkProgram& program, JerkState& state);

  const Problem& problem() const { return p_; }
  JerkState& state() { return state_; }
  double objective() const { return state_.objective; }
  double duration_s() const { return state_.duration_s; }
  std::size_t parts() const { return state_.recoveries.size() / state_.values.size(); }
  const JerkJet& row(const RowSide& side) const { return state_.values[side.segment].rows[side.row]; }
  const JerkJet& energy(std::size_t segment, std::size_t part) const {
    return state_.values[segment].energy_J[part];
  }
  void add_equalities(double& work, double& worst) const;
  [[nodiscard]] double dual_error() const;

  /// Assembles the matrices at the state.
  [[nodiscard]] bool factor();
  /// The matrices are shifted until the steps descend; nothing if that fails.
  [[nodiscard]] std::optional<StepSizes> solve();
  void take(const StepSizes& sizes);
  void evaluate() { state_.evaluate(program_); }

 private:
  using Jet = JerkJet;
  void assemble_energy(std::size_t segment);
  void assemble_kinematics(std::size_t segment);
  void right_side();
  [[nodiscard]] bool solve_shifted();
  void price_time();
  StepSizes expand();
  double change(std::size_t segment, const Jet& jet) const;

  const JerkProgram& program_;
  const Problem& p_;
  JerkState& state_;
  StageSystem system_;
  double shift_{}, new_price_{};
  std::vector<std::array<double, 2>> new_lambda_{};
  std::vector<double> dx_{};
};

}  // namespace joulepath::nlp
