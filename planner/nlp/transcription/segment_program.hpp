#pragma once

#include <array>
#include <vector>

#include "planner/nlp/transcription/problem.hpp"

namespace joulepath::nlp {

inline constexpr int kFixed = -1;  ///< a value at a segment's end that is no unknown

/// Which unknowns a segment sees.
template <std::size_t N>
using Columns = std::array<int, N>;

/// Everything that a program says of one segment at a point, with derivatives by what the segment sees.
template <std::size_t N>
struct SegmentValues {
  std::vector<JetOf<N>> energy_J{};  ///< parts, by channel: all in the objective, some with recovery
  JetOf<N> duration_s{};
  std::vector<JetOf<N>> rows{};
};

/// A nonlinear program made of segments, as a sparse solver sees it. Recovered energy, the objective and the
/// row of time are those of problem(); the program says what the unknowns are, which rows tie them, and into
/// how many parts (`kParts`) a channel's energy is cut, each of which is recovered by itself.
template <class P>
concept SegmentProgram = requires(const P& program, const double* x, std::size_t i,
                                  SegmentValues<P::kLocal>& values) {
  { P::kParts } -> std::convertible_to<std::size_t>;
  { program.problem() } -> std::same_as<const Problem&>;
  { program.unknown_count() } -> std::same_as<std::size_t>;
  { program.start(i) } -> std::same_as<double>;
  { program.unknown_bounds(i) } -> std::same_as<Bounds>;
  { program.row_count(i) } -> std::same_as<std::size_t>;
  { program.row_bounds(i, i) } -> std::same_as<Bounds>;
  { program.columns(i) } -> std::same_as<Columns<P::kLocal>>;
  {program.evaluate(x, i, values)};
};

/// What a sparse solver finds for a program; rows in the order of the segments.
struct ProgramSolution {
  bool converged{};
  std::vector<double> x{};
  std::vector<double> z{};  ///< energy not recovered, [segment][channel][part]
  double objective{};
  double price_W{};                           ///< multiplier of the row of time
  std::vector<double> row_multiplier{};       ///< positive at the upper bound
  std::vector<double> recovery_multiplier{};  ///< of E + z >= 0, >= 0
  int iterations{};
  std::string message{};
};

}  // namespace joulepath::nlp
