#pragma once

#include <vector>

#include "planner/nlp/interval/range.hpp"
#include "planner/nlp/transcription/problem.hpp"

namespace joulepath::nlp {

/// Bounds of the motion in a segment, from the caps of the rate and from rows that are always kept; they
/// decide whether a row of another limit is needed.
struct Reach {
  Range b0{}, b1{};  ///< squares of the rate at the ends
  Range a{};         ///< acceleration
};

/// Largest squares of the rate at all nodes that the caps and the limits of acceleration leave.
void reachable_squares(const Problem& problem, std::vector<double>& b);

/// For constant acceleration within a segment, by caps and limits of acceleration; `squares` from
/// reachable_squares. As a = (b1 - b0)/(2 ds), the squares bound it, too.
[[nodiscard]] Reach reach_of(const Problem& problem, const std::vector<double>& squares, std::size_t k);

/// For acceleration that is linear in time within a segment (JerkProgram). The squares at the nodes bound its
/// mean alone: from rest at constant jerk it is 4/3 of the mean at the end, and it may rise and fall again,
/// so only its own limits bound it. Inside of the segment b may be above both ends, up to
///   b(s) <= min(b0 + 2 a_max (s - s0), b1 - 2 a_min (s1 - s)),
/// and as the rate is a quadratic Bezier curve in time, up to the square of its middle point, which is at
/// most the mean of the caps. `b0` and `b1` are the same range: the middle's as well.
[[nodiscard]] Reach reach_with_jerk(const Problem& problem, const std::vector<double>& squares,
                                    std::size_t k);

/// The same, narrowed by the rows of yaw acceleration. For constant acceleration within a segment.
[[nodiscard]] Reach within_yaw_limit(Reach reach, const Segment& segment, double yaw_acceleration_rad_s2);

/// Whether a row that is linear in the acceleration and the square of the rate, turn a + turn' b, is at the
/// segment's middle the mean of its values at both ends: so it is where curvature is linear in s and
/// acceleration constant.
[[nodiscard]] bool middle_is_mean(const Segment& segment);

}  // namespace joulepath::nlp
