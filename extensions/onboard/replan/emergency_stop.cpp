#include "extensions/onboard/replan/emergency_stop.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath {
namespace {

constexpr double kBraking = 0.9999;  ///< of the limit

double most_deceleration(const nlp::Problem& problem) {
  const Limits& limits = problem.request->limits;
  return kBraking *
         (is_turn(problem.request->piece) ? limits.yaw_acceleration_rad_s2 : limits.deceleration_m_s2);
}

/// The square of the rate behind a segment that is nearest to the wanted one under the segment's rows.
double nearest_square(const nlp::Problem& problem, std::size_t k, double b0, double wanted) {
  double low = 0, high = kNoLimit;
  const double at = std::max(wanted, 1e-6 * b0);
  const nlp::Interval<nlp::Jet> interval = nlp::jet_interval(problem.segments[k], b0, at);
  for (std::size_t i = problem.first_row[k]; i < problem.first_row[k + 1]; ++i) {
    const nlp::ActiveRow& row = problem.rows[i];
    const nlp::Jet g = nlp::evaluate_row(problem, row, interval);
    if (std::abs(g.d[1]) < 1e-12) continue;
    const double to_low = at + (row.bounds.low - g.value) / g.d[1];
    const double to_high = at + (row.bounds.high - g.value) / g.d[1];
    low = std::max(low, std::min(to_low, to_high));
    high = std::min(high, std::max(to_low, to_high));
  }
  return std::max(low, std::min(wanted, high));
}

}  // namespace

void emergency_stop(const nlp::Problem& problem, double room, std::vector<double>& s,
                    std::vector<double>& b) {
  s.assign(1, problem.s.front());
  b.assign(1, problem.b_start);
  const double most = most_deceleration(problem);
  const double deceleration = room > 0 ? std::min(problem.b_start / (2 * room), most) : most;
  for (std::size_t k = 0; k < problem.segment_count() && b.back() > 0; ++k) {
    const double ds = problem.segments[k].ds, b0 = b.back();
    const double wanted = b0 - 2 * deceleration * ds;
    const double b1 = nearest_square(problem, k, b0, wanted);
    const bool stands = wanted <= 0 && b1 <= 1e-6 * b0;
    s.push_back(stands ? s.back() + b0 / (2 * deceleration) : problem.s[k + 1]);
    b.push_back(stands ? 0.0 : b1);
  }
  if (s.size() > 1) return;
  s.push_back(s.front());  // it stands
  b.push_back(0.0);
}

}  // namespace joulepath
