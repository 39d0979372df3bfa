#pragma once

#include <array>
#include <optional>

#include "planner/nlp/transcription/problem.hpp"

namespace joulepath::nlp {

/// Whether the power has kinks that can be rounded.
[[nodiscard]] bool has_kinks(const Problem& problem);

/// Final widths (Nm, A) to be tried one after the other where a solver does not converge.
inline constexpr std::array kFinalWidths{0.01, 0.05, 0.25};

/// A problem whose power has kinks (gear loss, driver drop), rounded widely at first and less with every
/// iteration: Newton steps of a narrow kink swing about it. Where they still do, the second derivative of the
/// kink is taken from a larger width (KinkRounding::width_before): steps become shorter, the gradient stays.
/// A problem without kinks stays as it is.
class NarrowingKinks {
 public:
  NarrowingKinks(const Problem& problem, double least_width);
  NarrowingKinks(const NarrowingKinks&) = delete;  // segments point to rounding_
  NarrowingKinks& operator=(const NarrowingKinks&) = delete;

  const Problem& problem() const { return rounded_ ? *rounded_ : original_; }
  /// Sets the first width from squares of the rate at all nodes, and how far from the optimum they are.
  void start(const std::vector<double>& b, double gap);
  /// Narrows after a step; `open` is what is still open of the optimality conditions, of the objective.
  void narrow(double open);
  /// Whether the kinks are as narrow as they will be.
  bool has_converged() const;

 private:
  const Problem& original_;
  std::optional<Problem> rounded_{};
  KinkRounding rounding_{};
  double first_width_{}, least_width_{};
  double caution_{1};  ///< width of the second derivative over the width
  double open_before_{kNoLimit};
};

}  // namespace joulepath::nlp
