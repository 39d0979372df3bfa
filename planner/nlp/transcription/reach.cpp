#include "planner/nlp/transcription/reach.hpp"

#include <algorithm>
#include <cmath>

#include "planner/motion/path_motion.hpp"

namespace joulepath::nlp {
namespace {

constexpr double kSame = 1e-9;  ///< relative

/// The segment's limits of acceleration: Range(-braking, speeding up).
Range acceleration_limits(const Problem& problem, std::size_t k) {
  const Limits& limits = problem.request->limits;
  if (problem.segments[k].limit_points[0].rates.along != 0)
    return {-limits.deceleration_m_s2, limits.acceleration_m_s2};
  return {-limits.yaw_acceleration_rad_s2, limits.yaw_acceleration_rad_s2};
}

Range intersection(const Range& x, const Range& y) {
  return {std::max(x.low, y.low), std::min(x.high, y.high)};
}

}  // namespace

void reachable_squares(const Problem& problem, std::vector<double>& b) {
  b.clear();
  for (const RateCap& cap : problem.cap) b.push_back(cap.squared);
  b.front() = problem.b_start;
  b.back() = problem.b_end;
  const std::size_t last = problem.segment_count();
  for (std::size_t k = 0; k + 1 < last; ++k)
    b[k + 1] = std::min(b[k + 1], b[k] + 2 * problem.segments[k].ds * acceleration_limits(problem, k).high);
  for (std::size_t k = last; k-- > 1;)
    b[k] = std::min(b[k], b[k + 1] - 2 * problem.segments[k].ds * acceleration_limits(problem, k).low);
}

Reach reach_of(const Problem& problem, const std::vector<double>& squares, std::size_t k) {
  const double b0 = squares[k], b1 = squares[k + 1], ds = problem.segments[k].ds;
  return {
      {0.0, b0}, {0.0, b1}, intersection(acceleration_limits(problem, k), {-b0 / (2 * ds), b1 / (2 * ds)})};
}

Reach reach_with_jerk(const Problem& problem, const std::vector<double>& squares, std::size_t k) {
  const double b0 = squares[k], b1 = squares[k + 1], ds = problem.segments[k].ds;
  const Range a = acceleration_limits(problem, k);
  // The steepest rise from b0 and the steepest fall to b1 meet here.
  const double apex = (a.high * b1 - a.low * b0 - 2 * a.high * a.low * ds) / (a.high - a.low);
  const double middle_rate =
      0.5 * (std::sqrt(problem.cap[k].squared) + std::sqrt(problem.cap[k + 1].squared));
  const double inside = std::fmin(apex, middle_rate * middle_rate);  // not a number if nothing limits a
  const Range b{0.0, std::max({b0, b1, inside})};
  return {b, b, a};
}

Reach within_yaw_limit(Reach reach, const Segment& segment, double yaw_acceleration_rad_s2) {
  if (!std::isfinite(yaw_acceleration_rad_s2)) return reach;
  Range a = reach.a;
  for (const SegmentPoint& point : segment.limit_points) {
    const double turn = point.rates.turn;
    if (turn == 0) continue;
    const Range b = (1 - point.fraction) * reach.b0 + point.fraction * reach.b1;
    const Range rest = Range(-yaw_acceleration_rad_s2, yaw_acceleration_rad_s2) - point.rates.turn_slope * b;
    a = intersection(a, (1 / turn) * rest);
  }
  if (a.low <= a.high) reach.a = a;  // else nothing is feasible; other code reports that
  return reach;
}

bool middle_is_mean(const Segment& segment) {
  const PathRates &first = segment.limit_points[0].rates, &middle = segment.limit_points[1].rates,
                  &last = segment.limit_points[2].rates;
  const auto same = [](double x, double y, double scale) { return std::abs(x - y) <= kSame * scale; };
  const double turn = std::abs(first.turn) + std::abs(last.turn), slope = std::abs(middle.turn_slope);
  return same(2 * middle.turn, first.turn + last.turn, turn) &&
         same(first.turn_slope, middle.turn_slope, slope) &&
         same(last.turn_slope, middle.turn_slope, slope) && first.along == last.along;
}

}  // namespace joulepath::nlp
