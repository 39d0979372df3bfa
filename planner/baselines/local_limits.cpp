#include "planner/baselines/local_limits.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "planner/motion/path_motion.hpp"
#include "planner/nlp/transcription/grid.hpp"

namespace joulepath {
namespace {

constexpr std::size_t kNodes = 300;

}  // namespace

LocalLimits::LocalLimits(const ProfileRequest& request) : request_(&request) {
  const PathMotion motion = path_motion(request);
  problem_ = nlp::transcribe(request, motion, nlp::make_grid(motion, request, kNodes), {}, nullptr);
  for (const nlp::Segment& segment : problem_.segments) {
    SegmentTurns& turns = turns_.emplace_back();
    for (std::size_t i = 0; i < turns.size(); ++i) {
      const PathRates& rates = segment.limit_points[i].rates;
      turns[i] = {std::abs(rates.turn), std::abs(rates.turn_slope), rates.turn * rates.turn_slope >= 0};
    }
  }
}

bool LocalLimits::curves() const {
  if (is_turn(request_->piece) || !std::isfinite(request_->limits.yaw_acceleration_rad_s2)) return false;
  const auto changes = [](const nlp::SegmentPoint& point) { return point.rates.turn_slope != 0; };
  return std::any_of(problem_.segments.begin(), problem_.segments.end(), [&](const nlp::Segment& segment) {
    return std::any_of(segment.limit_points.begin(), segment.limit_points.end(), changes);
  });
}

std::vector<double> LocalLimits::shares() const {
  if (!curves()) return {1.0};
  return {1.0, 0.9, 0.75, 0.5, 0.25};
}

void LocalLimits::Grid::insert(double place) {
  const auto after = std::upper_bound(s.begin(), s.end(), place);
  if (after == s.begin() || after == s.end()) return;
  const auto k = after - s.begin();
  const double before = *(after - 1), gap = *after - before;
  if (place - before < 1e-6 * gap || *after - place < 1e-6 * gap) return;
  const double share = (place - before) / gap;
  const auto at = static_cast<std::size_t>(k);
  const double cap_here = (1 - share) * cap[at - 1] + share * cap[at];
  s.insert(s.begin() + k, place);
  cap.insert(cap.begin() + k, cap_here);
  segment.insert(segment.begin() + k, segment[at - 1]);
}

LocalLimits::Grid LocalLimits::grid(double curve_share) const {
  const double limit = request_->limits.yaw_acceleration_rad_s2;
  Grid grid{problem_.s, {}, std::vector<std::size_t>(problem_.segment_count())};
  std::iota(grid.segment.begin(), grid.segment.end(), std::size_t{0});
  for (const nlp::RateCap& cap : problem_.cap) grid.cap.push_back(std::min(cap.squared, 1e6));
  for (std::size_t k = 0; k < problem_.segment_count(); ++k)
    for (const nlp::SegmentPoint& point : problem_.segments[k].limit_points) {
      const double slope = std::abs(point.rates.turn_slope);
      if (!(slope > 0)) continue;
      for (double* cap : {&grid.cap[k], &grid.cap[k + 1]}) *cap = std::min(*cap, curve_share * limit / slope);
    }
  return grid;
}

double LocalLimits::steepest(std::size_t segment, double ds, double b, bool accelerates) const {
  const double limit = request_->limits.yaw_acceleration_rad_s2;
  double least = kNoLimit;
  for (const auto& [turn, slope, winds] : turns_[segment]) {
    if (!(turn > 0)) continue;
    // b is the smaller square of the two ends; where both terms have the same sign, the larger square counts.
    const double most = winds == accelerates ? std::max(0.0, limit - slope * b) / (turn + 2 * ds * slope)
                                             : (limit + slope * b) / turn;
    least = std::min(least, most);
  }
  return least;
}

std::vector<double> LocalLimits::below(const Grid& grid, std::vector<double> b, double acceleration,
                                       double deceleration) const {
  const std::vector<double>& s = grid.s;
  for (std::size_t k = 0; k < s.size(); ++k) b[k] = std::min(b[k], grid.cap[k]);
  b.front() = std::min(b.front(), problem_.b_start);
  b.back() = std::min(b.back(), problem_.b_end);
  const auto gain = [&](std::size_t k, double square, double most, bool accelerates) {
    const double ds = s[k + 1] - s[k];
    return 2 * std::min(most, steepest(grid.segment[k], ds, square, accelerates)) * ds;
  };
  for (std::size_t k = 0; k + 1 < s.size(); ++k)
    b[k + 1] = std::min(b[k + 1], b[k] + gain(k, b[k], acceleration, true));
  for (std::size_t k = s.size() - 1; k-- > 0;)
    b[k] = std::min(b[k], b[k + 1] + gain(k, b[k + 1], deceleration, false));
  return b;
}

bool LocalLimits::passes(const std::vector<double>& b) const {
  constexpr double kRounding = 1e-9;
  if (b.front() < problem_.b_start - kRounding || b.back() < problem_.b_end - kRounding) return false;
  return std::all_of(b.begin() + 1, b.end() - 1, [](double square) { return square > 0; });
}

}  // namespace joulepath
