#pragma once

#include <vector>

#include "planner/nlp/problem.hpp"
#include "planner/nlp/range.hpp"

namespace joulepath::nlp {

/// What the motion can be in a segment, by the caps of the rate and by rows that are never left out: rows of
/// the other limits are judged by it.
struct Reach {
  Range b0{}, b1{};  ///< squares of the rate at the ends
  Range a{};         ///< acceleration
};

/// Largest squares of the rate at all nodes that the caps and the limits of acceleration leave.
[[nodiscard]] std::vector<double> reachable_squares(const Problem& problem);

/// By caps and limits of acceleration; `squares` from reachable_squares.
[[nodiscard]] Reach reach_of(const Problem& problem, const std::vector<double>& squares, std::size_t k);

/// The same, narrowed by the rows of yaw acceleration. For constant acceleration within a segment.
[[nodiscard]] Reach within_yaw_limit(Reach reach, const Segment& segment, double yaw_acceleration_rad_s2);

/// Whether a row that is linear in the acceleration and the square of the rate, turn a + turn' b, is at the
/// segment's middle the mean of its values at both ends: so it is where curvature is linear in s and
/// acceleration constant.
[[nodiscard]] bool middle_is_mean(const Segment& segment);

}  // namespace joulepath::nlp
