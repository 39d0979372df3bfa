#pragma once

#include <array>
#include <vector>

#include "planner/nlp/transcription/problem.hpp"

namespace joulepath::nlp {

inline constexpr int kFixed = -1;  ///< a value at a segment's end that is fixed

/// The unknowns of a segment.
template <std::size_t N>
using Columns = std::array<int, N>;

/// A segment's functions at a point, with derivatives by the segment's unknowns.
template <std::size_t N>
struct SegmentValues {
  std::vector<JetOf<N>> energy_J{};  ///< parts, by channel: all in the objective, some with recovery
  JetOf<N> duration_s{};
  std::vector<JetOf<N>> rows{};
};

/// A nonlinear program made of segments, as the input of a sparse solver. Recovered energy, the objective and
/// the duration row are those of problem(). The program defines the unknowns, the rows that couple them, and
/// the number of parts (`kParts`) of a channel's energy that are recovered separately.
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

/// A sparse solver's solution of a program; rows in the order of the segments.
struct ProgramSolution {
  bool converged{};
  std::vector<double> x{};
  std::vector<double> z{};  ///< energy not recovered, [segment][channel][part]
  double objective{};
  double price_W{};                           ///< multiplier of the duration row
  std::vector<double> row_multiplier{};       ///< positive at the upper bound
  std::vector<double> recovery_multiplier{};  ///< of E + z >= 0, >= 0
  int iterations{};
  std::string message{};
};

}  // namespace joulepath::nlp
