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

  /// Assembles the matrices at the state.
  void assemble();
  /// Steps of all unknowns and pairs towards the target complementarities (Pair::corrected). The matrices are
  /// shifted until the steps descend; nothing if that fails.
  [[nodiscard]] std::optional<StepSizes> solve();
  /// Applies the last step and evaluates the program there.
  void take(const StepSizes& sizes);

  /// Sum over the unknowns of |gradient of the Lagrangian times the unknown|.
  [[nodiscard]] double dual_error() const;

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
