#include "planner/nlp/transcription/row_selection.hpp"

#include <cmath>
#include <utility>

#include "planner/nlp/transcription/reach.hpp"

namespace joulepath::nlp {
namespace {

class RowSelection {
 public:
  RowSelection(Problem& problem, const std::vector<Tightening>& tightenings,
               const std::vector<double>& squares)
      : problem_(problem),
        tightenings_(tightenings),
        squares_(squares),
        steady_(!std::isfinite(problem.request->limits.jerk_m_s3) || is_turn(problem.request->piece)) {}

  void add_segment(std::size_t k) {
    add_all(k, std::make_index_sequence<std::tuple_size_v<Rows>>());
    problem_.first_row.push_back(problem_.rows.size());
  }

 private:
  /// In a turn in place the limit of yaw acceleration is that of the path's rate.
  static bool along(const Segment& segment) { return segment.limit_points[0].rates.along != 0; }

  template <std::size_t... I>
  void add_all(std::size_t k, std::index_sequence<I...>) {
    const Segment& segment = problem_.segments[k];
    const Reach by_bounds =
        steady_ ? reach_of(problem_, squares_, k) : reach_with_jerk(problem_, squares_, k);
    const Reach by_yaw =
        steady_ && along(segment)
            ? within_yaw_limit(by_bounds, segment, problem_.request->limits.yaw_acceleration_rad_s2)
            : by_bounds;
    const bool without_middle = steady_ && middle_is_mean(segment);
    (add<I>(k, I <= kYawTerm ? by_bounds : by_yaw, without_middle), ...);
  }

  /// `without_middle`: linear rows at the segment's middle are implied by those at its ends.
  template <std::size_t Index>
  void add(std::size_t k, const Reach& reach, bool without_middle) {
    const auto& term = std::get<Index>(problem_.terms);
    using Term = std::decay_t<decltype(term)>;
    const Segment& segment = problem_.segments[k];
    const Interval<Range> interval{segment,        reach.b0, reach.b1, sqrt(reach.b0),
                                   sqrt(reach.b1), reach.a,  Range()};
    const double factor = factor_for(tightenings_, Term::name, segment.s0, segment.s0 + segment.ds);
    for (std::size_t row = 0; row < Term::rows; ++row) {
      if (Index <= kLastLinearTerm && without_middle && Term::rows > 1 && is_middle<Term>(row)) continue;
      const Bounds bounds = term.bounds(segment, row);
      if (!std::isfinite(bounds.low) && !std::isfinite(bounds.high)) continue;
      const Range values = term(interval, row);
      const Bounds tight{bounds.low * factor, bounds.high * factor};
      // The first two terms determine the reach, so it does not decide about them.
      const bool makes_reach = Index == 0 || (Index == kYawTerm && !along(segment));
      if (!makes_reach && values.low >= tight.low && values.high <= tight.high) continue;
      problem_.rows.push_back({k, Index, row, tight, Term::name});
    }
  }

  template <class Term>
  static bool is_middle(std::size_t row) {
    return row * kLimitPoints / Term::rows == kLimitPoints / 2;
  }

  Problem& problem_;
  const std::vector<Tightening>& tightenings_;
  const std::vector<double>& squares_;
  bool steady_;  ///< acceleration is constant within a segment
};

}  // namespace

void select_rows(Problem& problem, const std::vector<Tightening>& tightenings, std::vector<double>& squares) {
  reachable_squares(problem, squares);
  problem.rows.clear();
  problem.first_row.assign(1, 0);
  RowSelection selection(problem, tightenings, squares);
  for (std::size_t k = 0; k < problem.segment_count(); ++k) selection.add_segment(k);
}

}  // namespace joulepath::nlp
