#include "planner/nlp/transcription/forward_backward.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath::nlp {
namespace {

constexpr double kLargest = 1e6;       ///< square of a rate that nothing reaches
constexpr double kStandstill = 1e-15;  ///< a square of the rate that is rounding
constexpr int kSweeps = 12;
constexpr int kSlowings = 8;  ///< halvings of the rate

/// alpha b0 + beta b1 <= gamma.
struct HalfPlane {
  double alpha{}, beta{}, gamma{};
  std::string_view limit{};
};

/// Whether a half plane bounds b0 alone, but for rounding.
bool ignores_next(const HalfPlane& p) { return std::abs(p.beta) <= 1e-6 * std::abs(p.alpha) + 1e-14; }

struct Span {
  double low{}, high{};
  std::string_view low_limit{}, high_limit{};
  void raise(double to, std::string_view limit) {
    if (to > low) low = to, low_limit = limit;
  }
  void lower(double to, std::string_view limit) {
    if (to < high) high = to, high_limit = limit;
  }
};

double capped(const Problem& problem, std::size_t node) {
  if (node == 0) return problem.b_start;
  if (node + 1 == problem.node_count()) return problem.b_end;
  return std::min(problem.cap[node].squared, kLargest);
}

std::vector<HalfPlane> half_planes(const Problem& problem, std::size_t k, const std::vector<double>& at) {
  std::vector<HalfPlane> planes;
  const Interval<Jet> interval = jet_interval(problem.segments[k], at[k], at[k + 1]);
  for (std::size_t i = problem.first_row[k]; i < problem.first_row[k + 1]; ++i) {
    const ActiveRow& row = problem.rows[i];
    const Jet g = evaluate_row(problem, row, interval);
    const double offset = g.value - g.d[0] * at[k] - g.d[1] * at[k + 1];
    if (std::isfinite(row.bounds.high))
      planes.push_back({g.d[0], g.d[1], row.bounds.high - offset, row.name});
    if (std::isfinite(row.bounds.low))
      planes.push_back({-g.d[0], -g.d[1], offset - row.bounds.low, row.name});
  }
  return planes;
}

/// Values of b0 for which some b1 within `next` satisfies every half plane.
Span project(const std::vector<HalfPlane>& planes, const Span& next, double cap, std::string_view cap_limit) {
  Span span{0.0, cap, "", cap_limit};
  // alpha b0 <= gamma bounds b0 by itself.
  const auto bound = [&span](double alpha, double gamma, std::string_view limit) {
    if (std::abs(alpha) < 1e-14) {
      if (gamma < -1e-12 * (1 + std::abs(gamma))) span.lower(-1.0, limit);  // nothing satisfies it
    } else if (alpha > 0) {
      span.lower(gamma / alpha, limit);
    } else {
      span.raise(gamma / alpha, limit);
    }
  };
  std::vector<HalfPlane> above{{0, 1, next.high, next.high_limit}}, below{{0, -1, -next.low, next.low_limit}};
  for (const HalfPlane& p : planes) {
    if (ignores_next(p))
      bound(p.alpha, p.gamma - std::max(0.0, p.beta) * next.high, p.limit);
    else if (p.beta > 0)
      above.push_back({p.alpha / p.beta, 1, p.gamma / p.beta, p.limit});
    else
      below.push_back({-p.alpha / p.beta, -1, -p.gamma / p.beta, p.limit});
  }
  // above: b1 <= gamma - alpha b0; below: b1 >= alpha b0 - gamma (sign folded): add the two.
  for (const HalfPlane& up : above)
    for (const HalfPlane& down : below)
      bound(up.alpha + down.alpha, up.gamma + down.gamma, down.limit.empty() ? up.limit : down.limit);
  return span;
}

/// Values of b1 that are possible behind a given b0.
Span step(const std::vector<HalfPlane>& planes, double b0, const Span& next) {
  Span span = next;
  for (const HalfPlane& p : planes) {
    if (ignores_next(p)) continue;
    const double gamma = p.gamma - p.alpha * b0;
    if (p.beta > 0)
      span.lower(gamma / p.beta, p.limit);
    else
      span.raise(gamma / p.beta, p.limit);
  }
  return span;
}

Blocked blocked_at(std::size_t node, const Span& span) {
  const std::string_view limit = span.high_limit.empty() ? span.low_limit : span.high_limit;
  return {node, limit, span.low, std::max(0.0, span.high)};
}

RateEnvelope sweep(const Problem& problem, const std::vector<double>& at) {
  const std::size_t last = problem.segment_count();
  std::vector<Span> span(last + 1);
  std::vector<std::vector<HalfPlane>> planes(last);
  span[last] = {problem.b_end, problem.b_end, "end_speed", "end_speed"};
  RateEnvelope envelope;
  const RateCap& end_cap = problem.cap[last];
  if (problem.b_end > end_cap.squared * (1 + 1e-9)) {
    envelope.blocked = {last, end_cap.limit, problem.b_end, end_cap.squared};
    return envelope;
  }
  for (std::size_t k = last; k-- > 0;) {
    planes[k] = half_planes(problem, k, at);
    const double cap = k == 0 ? std::min(problem.cap[0].squared, kLargest) : capped(problem, k);
    span[k] = project(planes[k], span[k + 1], cap, problem.cap[k].limit);
    if (span[k].high < span[k].low * (1 - 1e-9) - 1e-12 || span[k].high < 0 ||
        (k > 0 && span[k].high <= kStandstill)) {
      envelope.blocked = blocked_at(k, span[k]);
      return envelope;
    }
  }
  const double start = problem.b_start, slack = 1e-9 * (1 + start);
  if (start > span[0].high + slack || start < span[0].low - slack) {
    const bool fast = start > span[0].high;
    envelope.blocked = {0, fast ? span[0].high_limit : span[0].low_limit, start, span[0].high};
    if (!fast) envelope.blocked = {0, span[0].low_limit, span[0].low, start};
    return envelope;
  }
  envelope.fastest.assign(1, start);
  envelope.slowest.assign(1, start);
  for (std::size_t k = 0; k < last; ++k) {
    const Span up = step(planes[k], envelope.fastest[k], span[k + 1]);
    const Span down = step(planes[k], envelope.slowest[k], span[k + 1]);
    const double fast = std::clamp(up.high, span[k + 1].low, span[k + 1].high);
    if (k + 1 < last && !(fast > kStandstill)) {
      envelope.blocked = blocked_at(k + 1, up);
      return envelope;
    }
    envelope.fastest.push_back(fast);
    envelope.slowest.push_back(std::clamp(std::max(down.low, span[k + 1].low), 0.0, span[k + 1].high));
  }
  envelope.fastest.back() = problem.b_end;
  envelope.slowest.back() = problem.b_end;
  return envelope;
}

/// True if a row is not affine in the squares of the rates. A term that is not listed here counts as
/// nonlinear.
bool bends(const Problem& problem) {
  constexpr std::string_view kStraight[] = {Acceleration::name, YawAcceleration::name,
                                            WheelAcceleration::name, Traction::name};
  return std::any_of(problem.rows.begin(), problem.rows.end(), [&](const ActiveRow& row) {
    return std::find(std::begin(kStraight), std::end(kStraight), row.name) == std::end(kStraight) ||
           !problem.segments[row.segment].limit_points[0].affine;
  });
}

/// The tangent of a nonlinear row at a speed that the row forbids may exclude every speed (a voltage is
/// concave in the square of the rate). If the first sweep is blocked, it is repeated about slower profiles
/// before the request counts as blocked.
RateEnvelope first_sweep(const Problem& problem, std::vector<double>& at) {
  RateEnvelope envelope = sweep(problem, at);
  for (int i = 0; i < kSlowings && envelope.blocked; ++i) {
    for (std::size_t k = 1; k + 1 < at.size(); ++k) at[k] *= 0.25;
    RateEnvelope slower = sweep(problem, at);
    if (!slower.blocked) envelope = std::move(slower);
  }
  return envelope;
}

}  // namespace

RateEnvelope rate_envelope(const Problem& problem) {
  std::vector<double> at(problem.node_count());
  for (std::size_t k = 0; k < at.size(); ++k) {
    const double from_start = problem.b_start + 2 * problem.s[k];
    const double from_end = problem.b_end + 2 * (problem.s.back() - problem.s[k]);
    at[k] = k == 0 || k + 1 == at.size() ? capped(problem, k)
                                         : std::min({capped(problem, k), from_start, from_end, 4.0});
  }
  if (!bends(problem)) return sweep(problem, at);
  RateEnvelope envelope = first_sweep(problem, at);
  for (int i = 0; i < kSweeps && !envelope.blocked; ++i) {
    double change = 0;
    for (std::size_t k = 1; k + 1 < at.size(); ++k) {
      const double to = std::max(envelope.fastest[k], 1e-9);
      change = std::max(change, std::abs(to - at[k]) / (to + at[k]));
      at[k] = to;
    }
    if (change < 1e-9) break;
    RateEnvelope next = sweep(problem, at);
    if (next.blocked) break;
    envelope = std::move(next);
  }
  return envelope;
}

}  // namespace joulepath::nlp
