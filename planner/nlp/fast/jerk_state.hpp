#pragma once

#include <array>
#include <vector>

#include "planner/nlp/fast/fast_state.hpp"
#include "planner/nlp/transcription/jerk_program.hpp"

namespace joulepath::nlp {

/// A bound of an unknown: sign (bound - x) > 0.
struct BoundSide {
  std::size_t unknown{};
  double sign{};
  double bound{};
  Pair pair{};
};

/// All variables of an interior-point iteration of a JerkProgram, and the program's functions there.
/// RowSide::row counts within its segment.
struct JerkState : SegmentPairs {
  std::vector<double> x{};
  std::vector<BoundSide> bounds{};
  std::vector<std::array<double, 2>> lambda{};  ///< multipliers of the kinematics, per segment

  std::vector<SegmentValues<JerkProgram::kLocal>> values{};  ///< of the program at x
  double objective{};                                        ///< without recovery
  double duration_s{};

  void evaluate(const JerkProgram& program);

  template <class Function>
  void for_each_pair(Function&& use) {
    for (BoundSide& side : bounds) use(side.pair);
    for_each_segment_pair(use);
  }
};

/// A strictly positive state near the program's guess. `gap`: complementarity of every pair, as a share of a
/// segment's part of the objective.
[[nodiscard]] JerkState starting_state(const JerkProgram& program, double gap);

}  // namespace joulepath::nlp
