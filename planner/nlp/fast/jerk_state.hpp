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
struct JerkState {
  std::vector<double> x{};
  std::vector<BoundSide> bounds{};
  std::vector<RowSide> sides{};
  std::vector<Recovery> recoveries{};           ///< [segment][channel][part]
  std::vector<std::array<double, 2>> lambda{};  ///< multipliers of the kinematics, per segment
  Pair time{};                                  ///< slack of the duration's budget
  double price{};                               ///< multiplier of a duration that is fixed
  double time_residual{};                       ///< of the duration's row
  DurationRow duration_row{};

  std::vector<SegmentValues<JerkProgram::kLocal>> values{};  ///< of the program at x
  double objective{};                                        ///< without recovery
  double duration_s{};

  bool has_duration() const { return duration_row != DurationRow::none; }
  bool has_budget() const { return duration_row == DurationRow::at_most; }
  double multiplier_of_time() const { return !has_duration() ? 0.0 : has_budget() ? time.y : price; }
  /// Number of separately recovered parts of energy per segment.
  std::size_t parts() const { return recoveries.size() / values.size(); }

  void evaluate(const JerkProgram& program);

  template <class Function>
  void for_each_pair(Function&& use) {
    for (BoundSide& side : bounds) use(side.pair);
    for (RowSide& side : sides) use(side.pair);
    for (Recovery& recovery : recoveries) use(recovery.z), use(recovery.sum);
    if (has_budget()) use(time);
  }
};

/// A strictly positive state near the program's guess. `gap`: complementarity of every pair, as a share of a
/// segment's part of the objective.
[[nodiscard]] JerkState starting_state(const JerkProgram& program, double gap);

}  // namespace joulepath::nlp
