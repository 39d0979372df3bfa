#include "planner/profile/certificate.hpp"

#include <algorithm>
#include <cmath>

#include "planner/nlp/transcription/segment_jets.hpp"
// Design: docs/decisions/0052-certificate.md
namespace joulepath::nlp {
namespace {

double smallest_eigenvalue(const Jet& jet) {
  const double middle = 0.5 * (jet.dd[0] + jet.dd[2]), half = 0.5 * (jet.dd[0] - jet.dd[2]);
  return middle - std::hypot(half, jet.dd[1]);
}

/// sqrt(b1) - sqrt(b0): what the rate gains on a segment. Derivatives at rest are left out: only ends, which
/// are fixed, are at rest.
Jet rate_gain(double b0, double b1) {
  const auto slope = [](double b) { return b > 0 ? 0.5 / std::sqrt(b) : 0.0; };
  const auto bend = [&](double b) { return b > 0 ? -0.5 * slope(b) / b : 0.0; };
  return {std::sqrt(b1) - std::sqrt(b0), {-slope(b0), slope(b1)}, {-bend(b0), 0.0, bend(b1)}};
}

/// Joules per unit of rate gained: copper loss where friction's current and that of acceleration meet. It is
/// c of what running up costs more than slowing down between the same rates, K (b1 - b0) + c rate_gain.
double gain_cost(const Segment& segment, double b) {
  const auto odd_J = [&](double b0, double b1) {
    const SegmentJets up = segment_jets(segment, b0, b1), down = segment_jets(segment, b1, b0);
    return 0.5 *
           (up.energy_J[0].value + up.energy_J[1].value - down.energy_J[0].value - down.energy_J[1].value);
  };
  const double slow = rate_gain(0.2 * b, 0.3 * b).value, fast = rate_gain(0.8 * b, 0.9 * b).value;
  return (odd_J(0.2 * b, 0.3 * b) - odd_J(0.8 * b, 0.9 * b)) / (slow - fast);
}

class Certifier {
 public:
  Certifier(const Problem& problem, const Solution& solution, double gain_cost)
      : p_(problem), solution_(solution), gain_cost_(gain_cost) {}

  /// A segment's part of the Lagrangian, constants of the bounds included.
  Jet lagrangian(std::size_t k, double b0, double b1) const {
    const SegmentJets jets = segment_jets(p_.segments[k], b0, b1);
    Jet sum = (p_.time_weight_W + solution_.price_W) * jets.duration_s;
    for (std::size_t c = 0; c < 2; ++c) {
      double weight = p_.energy_weight;
      if (c < p_.channels)
        weight -= std::clamp(solution_.recovery_multiplier[k * p_.channels + c], 0.0, p_.recovery_weight);
      sum += weight * jets.energy_J[c];
    }
    if (gain_cost_ != 0) sum -= gain_cost_ * rate_gain(b0, b1);
    if (p_.first_row[k] == p_.first_row[k + 1]) return sum;
    const Interval<Jet> interval = jet_interval(p_.segments[k], b0, b1);
    for (std::size_t i = p_.first_row[k]; i < p_.first_row[k + 1]; ++i) {
      const double y = solution_.row_multiplier[i];
      const Bounds& bounds = p_.rows[i].bounds;
      const double bound = y > 0 ? bounds.high : bounds.low;
      if (y == 0 || !std::isfinite(bound)) continue;
      sum += y * (evaluate_row(p_, p_.rows[i], interval) - bound);
    }
    return sum;
  }

  /// Smallest eigenvalue of the segment's Hessian over samples of the box that accelerations can reach.
  double least_curvature(std::size_t k, double high0, double high1) const {
    constexpr double kShares[] = {0.001, 0.02, 0.2, 0.5, 0.8, 1.0};
    const Limits& limits = p_.request->limits;
    const bool turn = p_.segments[k].limit_points[0].rates.along == 0;
    const double up = turn ? limits.yaw_acceleration_rad_s2 : limits.acceleration_m_s2;
    const double down = turn ? limits.yaw_acceleration_rad_s2 : limits.deceleration_m_s2;
    const double ds = p_.segments[k].ds;
    const bool fixed0 = k == 0, fixed1 = k + 1 == p_.segment_count();
    double least = kNoLimit;
    for (double share0 : kShares) {
      const double b0 = fixed0 ? p_.b_start : share0 * high0;
      const double low1 = std::max(0.0, b0 - 2 * down * ds), most1 = std::min(high1, b0 + 2 * up * ds);
      if (most1 < low1) continue;
      for (double share1 : kShares) {
        const double b1 = fixed1 ? p_.b_end : low1 + share1 * (most1 - low1);
        if (b0 + b1 <= 0) continue;
        const Jet jet = lagrangian(k, b0, b1);
        if (fixed0 && fixed1) continue;
        least = std::min(least, fixed0 ? jet.dd[2] : fixed1 ? jet.dd[0] : smallest_eigenvalue(jet));
        if (fixed1) break;
      }
      if (fixed0) break;
    }
    return least;
  }

 private:
  const Problem& p_;
  const Solution& solution_;
  double gain_cost_{};  ///< subtracted from every segment: over all of them it adds up to a constant
};

Certificate certify_with(const Problem& problem, const Solution& solution, const std::vector<double>& fastest,
                         double gain_cost) {
  const Certifier certifier(problem, solution, gain_cost);
  const std::vector<double>& b = solution.b;
  std::vector<double> slope(b.size(), 0.0);
  Certificate result{.convex = true};
  double bound = problem.duration_row == DurationRow::none ? 0.0 : -solution.price_W * problem.duration_s;
  bound += gain_cost * (std::sqrt(b.back()) - std::sqrt(b.front()));
  double objective = 0;
  const auto reach = [&](std::size_t k) { return std::max(fastest[k], b[k]); };
  for (std::size_t k = 0; k < problem.segment_count(); ++k) {
    const SegmentJets jets = segment_jets(problem.segments[k], b[k], b[k + 1]);
    objective += problem.time_weight_W * jets.duration_s.value;
    for (std::size_t c = 0; c < 2; ++c) {
      const double E = jets.energy_J[c].value;
      objective += problem.energy_weight * E +
                   (c < problem.channels ? problem.recovery_weight * std::max(0.0, -E) : 0.0);
    }
    const Jet part = certifier.lagrangian(k, b[k], b[k + 1]);
    bound += part.value;
    slope[k] += part.d[0];
    slope[k + 1] += part.d[1];
    const double curvature = certifier.least_curvature(k, reach(k), reach(k + 1));
    if (curvature >= -1e-9 * (std::abs(part.dd[0]) + std::abs(part.dd[2]))) continue;
    result.convex = false;
    const auto square = [](double x) { return x * x; };
    bound += 0.5 * curvature *
             (square(std::max(b[k], reach(k) - b[k])) + square(std::max(b[k + 1], reach(k + 1) - b[k + 1])));
  }
  for (std::size_t k = 1; k + 1 < b.size(); ++k)
    bound -= slope[k] > 0 ? slope[k] * b[k] : -slope[k] * (reach(k) - b[k]);
  result.objective = objective;
  result.lower_bound = std::min(bound, objective);
  return result;
}

}  // namespace

Certificate certify(const Problem& problem, const Solution& solution, const std::vector<double>& fastest) {
  Certificate best = certify_with(problem, solution, fastest, 0.0);
  if (best.convex || problem.energy_weight == 0) return best;
  const std::size_t middle = problem.segment_count() / 2;
  const double cost = problem.energy_weight * gain_cost(problem.segments[middle], solution.b[middle]);
  for (double share : {0.5, 1.0}) {
    if (best.convex) break;
    const Certificate other = certify_with(problem, solution, fastest, share * cost);
    if (other.convex || other.lower_bound > best.lower_bound) best = other;
  }
  return best;
}

}  // namespace joulepath::nlp
