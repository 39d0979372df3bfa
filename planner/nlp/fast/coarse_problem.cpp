#include "planner/nlp/fast/coarse_problem.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath::nlp {
namespace {

constexpr double kJump = 0.02;  ///< share of the largest value on the path that counts as a jump

/// Whether curvature has a kink at the node after segment k.
bool kink_behind(const Problem& fine, std::size_t k, double largest_slope) {
  const double before = fine.segments[k].limit_points.back().rates.turn_slope;
  const double behind = fine.segments[k + 1].limit_points.front().rates.turn_slope;
  return std::abs(before - behind) > kJump * largest_slope;
}

/// Nodes of the fine problem that are kept: every few, and kinks of curvature, where the yaw rows change.
std::vector<std::size_t> kept_nodes(const Problem& fine, std::size_t merged) {
  double largest_slope = 0;
  for (const Segment& segment : fine.segments)
    for (const SegmentPoint& point : segment.limit_points)
      largest_slope = std::max(largest_slope, std::abs(point.rates.turn_slope));
  std::vector<std::size_t> kept{0};
  for (std::size_t k = 0; k + 1 < fine.segment_count(); ++k)
    if (k + 1 == kept.back() + merged || kink_behind(fine, k, largest_slope)) kept.push_back(k + 1);
  kept.push_back(fine.segment_count());
  return kept;
}

/// One segment over [first, last); its points take their places from the nearest ones there.
Segment merged_segment(const Problem& fine, std::size_t first, std::size_t last) {
  const std::vector<Segment>& from = fine.segments;
  const std::size_t count = last - first;
  Segment segment{.s0 = from[first].s0, .ds = fine.s[last] - fine.s[first], .plant = from[first].plant};
  segment.limit_points = {from[first].limit_points[0], from[first + count / 2].limit_points[count % 2],
                          from[last - 1].limit_points[kLimitPoints - 1]};
  segment.limit_points[1].fraction = 0.5;
  for (std::size_t q = 0; q < kEnergyPoints; ++q) {
    const auto at = static_cast<std::size_t>(kEnergyTimes[q] * static_cast<double>(count));
    segment.energy_points[q] = from[first + at].energy_points[q];
  }
  return segment;
}

/// Every row that one of the segments [first, last) has, once.
void add_rows(const Problem& fine, std::size_t first, std::size_t last, Problem& coarse) {
  const auto begin = static_cast<std::ptrdiff_t>(coarse.first_row.back());
  for (std::size_t i = fine.first_row[first]; i < fine.first_row[last]; ++i) {
    ActiveRow row = fine.rows[i];
    const auto same = [&](const ActiveRow& other) { return other.term == row.term && other.row == row.row; };
    if (std::any_of(coarse.rows.begin() + begin, coarse.rows.end(), same)) continue;
    row.segment = coarse.segments.size() - 1;
    coarse.rows.push_back(row);
  }
  coarse.first_row.push_back(coarse.rows.size());
}

}  // namespace

CoarseProblem coarsen(const Problem& fine, std::size_t merged) {
  CoarseProblem result{.problem = {.request = fine.request,
                                   .s = {fine.s.front()},
                                   .cap = {fine.cap.front()},
                                   .b_start = fine.b_start,
                                   .b_end = fine.b_end,
                                   .first_row = {0},
                                   .terms = fine.terms,
                                   .channels = fine.channels,
                                   .recovery_weight = fine.recovery_weight,
                                   .energy_weight = fine.energy_weight,
                                   .time_weight_W = fine.time_weight_W,
                                   .duration_row = fine.duration_row,
                                   .duration_s = fine.duration_s},
                       .node = kept_nodes(fine, merged)};
  Problem& coarse = result.problem;
  for (std::size_t i = 0; i + 1 < result.node.size(); ++i) {
    const std::size_t first = result.node[i], last = result.node[i + 1];
    coarse.segments.push_back(merged_segment(fine, first, last));
    add_rows(fine, first, last, coarse);
    coarse.s.push_back(fine.s[last]);
    coarse.cap.push_back(fine.cap[last]);
  }
  return result;
}

std::vector<double> CoarseProblem::restricted(const std::vector<double>& fine) const {
  std::vector<double> coarse;
  for (std::size_t k : node) coarse.push_back(fine[k]);
  return coarse;
}

std::vector<double> CoarseProblem::prolonged(const std::vector<double>& coarse, const Problem& fine) const {
  std::vector<double> b(fine.node_count(), coarse.back());
  for (std::size_t i = 0; i + 1 < node.size(); ++i) {
    const double s0 = problem.s[i], slope = (coarse[i + 1] - coarse[i]) / (problem.s[i + 1] - s0);
    for (std::size_t k = node[i]; k < node[i + 1]; ++k) b[k] = coarse[i] + slope * (fine.s[k] - s0);
  }
  return b;
}

}  // namespace joulepath::nlp
