#pragma once

#include <string_view>
#include <vector>

#include "planner/motion/path_motion.hpp"
#include "planner/nlp/transcription/formulation.hpp"
#include "planner/nlp/transcription/rate_cap.hpp"
#include "planner/values/profile.hpp"

namespace joulepath::nlp {

/// A limit that is tightened by a factor on a part of the path, because the dense check found an excess
/// between nodes.
struct Tightening {
  std::string_view limit{};
  double from{};
  double to{};
  double factor{1.0};
};

/// The factor of a limit on a part of the path: the product over all tightenings that touch it.
[[nodiscard]] double factor_for(const std::vector<Tightening>& tightenings, std::string_view limit,
                                double from, double to);

/// One row of one segment that can reach its bounds.
struct ActiveRow {
  std::size_t segment{};
  std::size_t term{};  ///< index in Rows
  std::size_t row{};   ///< of the term
  Bounds bounds{};
  std::string_view name{};
};

enum class DurationRow { none, at_most, equal };

/// The transcription on a grid: numbers for any solver.
struct Problem {
  const ProfileRequest* request{};
  std::vector<double> s{};
  std::vector<Segment> segments{};
  std::vector<RateCap> cap{};            ///< per node
  double b_start{}, b_end{};             ///< fixed
  std::vector<ActiveRow> rows{};         ///< by segment
  std::vector<std::size_t> first_row{};  ///< per segment, and one past the last
  Rows terms{};
  std::size_t channels{};     ///< of recovered energy: 0 where regeneration is perfect
  double recovery_weight{};   ///< 1 - eta
  double energy_weight{1.0};  ///< 0 for minimum time
  double time_weight_W{};     ///< standby + price; 1 for minimum time
  DurationRow duration_row{DurationRow::none};
  double duration_s{kNoLimit};

  std::size_t node_count() const { return s.size(); }
  std::size_t segment_count() const { return segments.size(); }
  /// Squares of the rate are unknown at all nodes but the first and the last.
  std::size_t unknown_count() const { return s.size() - 2; }
};

/// Transcribes a request on a grid. `previous` (may be null) gives the time at each place, and how the rate
/// changes within a segment.
[[nodiscard]] Problem transcribe(const ProfileRequest& request, const PathMotion& motion,
                                 const std::vector<double>& s, const std::vector<Tightening>& tightenings,
                                 const Profile* previous);

/// One segment of a transcription.
[[nodiscard]] Segment make_segment(const ProfileRequest& request, const PathMotion& motion, double s0,
                                   double s1, const Profile* previous);

/// Lowers the caps of a segment's two ends such that the chord between them stays below the caps inside.
void lower_caps(const ProfileRequest& request, const PathMotion& motion, const Segment& segment,
                const std::vector<Tightening>& tightenings, RateCap& cap0, RateCap& cap1);

/// Sets weights, channels and duration row from the request's plant and time goal.
void set_objective(Problem& problem);

/// Value of a row with its derivatives.
[[nodiscard]] Jet evaluate_row(const Problem& problem, const ActiveRow& row, const Interval<Jet>& interval);
[[nodiscard]] double evaluate_row(const Problem& problem, const ActiveRow& row,
                                  const Interval<double>& interval);
[[nodiscard]] JerkJet evaluate_row(const Problem& problem, const ActiveRow& row,
                                   const JerkInterval<JerkJet>& interval);

/// Exact duration of squares of the rate.
[[nodiscard]] double duration_of(const Problem& problem, const std::vector<double>& b);

}  // namespace joulepath::nlp
