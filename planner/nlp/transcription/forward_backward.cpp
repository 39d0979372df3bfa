#include "planner/nlp/transcription/forward_backward.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath::nlp {
namespace {

constexpr double kLargest = 1e6;       ///< square of a rate that nothing reaches
constexpr double kStandstill = 1e-15;  ///< a square of the rate that is rounding
constexpr int kSweeps = 12;
constexpr int kSlowings = 20;  ///< halvings of the rate

/// Whether a half plane bounds b0 alone, but for rounding.
bool ignores_next(const HalfPlane& p) { return std::abs(p.beta) <= 1e-6 * std::abs(p.alpha) + 1e-14; }

double capped(const Problem& problem, std::size_t node) {
  if (node == 0) return problem.b_start;
  if (node + 1 == problem.node_count()) return problem.b_end;
  return std::min(problem.cap[node].squared, kLargest);
}

void add_half_planes(const Problem& problem, std::size_t k, const std::vector<double>& at,
                     std::vector<HalfPlane>& planes) {
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
}

/// Values of b0 for which some b1 within `next` satisfies every half plane.
SquareSpan project(std::span<const HalfPlane> planes, const SquareSpan& next, double cap,
                   std::string_view cap_limit, std::vector<HalfPlane>& above, std::vector<HalfPlane>& below) {
  SquareSpan span{0.0, cap, "", cap_limit};
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
  above.assign(1, {0, 1, next.high, next.high_limit});
  below.assign(1, {0, -1, -next.low, next.low_limit});
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
SquareSpan step(std::span<const HalfPlane> planes, double b0, const SquareSpan& next) {
  SquareSpan span = next;
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

/// Largest b1 behind a given b0; below 0 if there is none.
double highest_behind(std::span<const HalfPlane> planes, double b0, const SquareSpan& next) {
  const SquareSpan span = step(planes, b0, next);
  return span.high < span.low ? -1.0 : span.high;
}

/// The b0 with the largest sum of both squares, where the largest b0 leaves only a standstill behind it: rows
/// of voltage and power do that on long segments, as a rate above the steady one needs hard braking. The sum
/// is concave in b0.
double balanced(std::span<const HalfPlane> planes, double low, double high, const SquareSpan& next) {
  constexpr int kCuts = 60;
  const auto sum = [&](double b0) { return b0 + highest_behind(planes, b0, next); };
  for (int i = 0; i < kCuts; ++i) {
    const double third = (high - low) / 3;
    if (sum(low + third) < sum(high - third))
      low += third;
    else
      high -= third;
  }
  return 0.5 * (low + high);
}

Blocked blocked_at(std::size_t node, const SquareSpan& span) {
  const std::string_view limit = span.high_limit.empty() ? span.low_limit : span.high_limit;
  return {node, limit, span.low, std::max(0.0, span.high)};
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

}  // namespace

void EnvelopeSweeps::reserve(std::size_t nodes) {
  at_.reserve(nodes);
  planes_.reserve(2 * kMostRows * nodes);
  first_plane_.reserve(nodes);
  above_.reserve(2 * kMostRows + 1);
  below_.reserve(2 * kMostRows + 1);
  span_.reserve(nodes);
  for (RateEnvelope* envelope : {&envelope_, &next_}) {
    envelope->fastest.reserve(nodes);
    envelope->slowest.reserve(nodes);
  }
}

void EnvelopeSweeps::sweep(const Problem& problem, RateEnvelope& envelope) {
  const std::size_t last = problem.segment_count();
  planes_.clear();
  first_plane_.assign(last + 1, 0);
  span_.assign(last + 1, {});
  span_[last] = {problem.b_end, problem.b_end, "end_speed", "end_speed"};
  envelope.fastest.clear();
  envelope.slowest.clear();
  envelope.blocked = sweep_backward(problem);
  if (!envelope.blocked) envelope.blocked = sweep_forward(problem, envelope);
}

std::span<const HalfPlane> EnvelopeSweeps::planes(std::size_t k) const {
  return std::span(planes_).subspan(first_plane_[k + 1], first_plane_[k] - first_plane_[k + 1]);
}

std::optional<Blocked> EnvelopeSweeps::sweep_backward(const Problem& problem) {
  const std::size_t last = problem.segment_count();
  const RateCap& end_cap = problem.cap[last];
  if (problem.b_end > end_cap.squared * (1 + 1e-9))
    return Blocked{last, end_cap.limit, problem.b_end, end_cap.squared};
  for (std::size_t k = last; k-- > 0;) {
    add_half_planes(problem, k, at_, planes_);
    first_plane_[k] = planes_.size();
    const double cap = k == 0 ? std::min(problem.cap[0].squared, kLargest) : capped(problem, k);
    span_[k] = project(planes(k), span_[k + 1], cap, problem.cap[k].limit, above_, below_);
    if (span_[k].high < span_[k].low * (1 - 1e-9) - 1e-12 || span_[k].high < 0 ||
        (k > 0 && span_[k].high <= kStandstill))
      return blocked_at(k, span_[k]);
  }
  const double start = problem.b_start, slack = 1e-9 * (1 + start);
  if (start > span_[0].high + slack) return Blocked{0, span_[0].high_limit, start, span_[0].high};
  if (start < span_[0].low - slack) return Blocked{0, span_[0].low_limit, span_[0].low, start};
  return std::nullopt;
}

std::optional<Blocked> EnvelopeSweeps::sweep_forward(const Problem& problem, RateEnvelope& envelope) const {
  const std::size_t last = problem.segment_count();
  envelope.fastest.assign(1, problem.b_start);
  envelope.slowest.assign(1, problem.b_start);
  for (std::size_t k = 0; k < last; ++k) {
    SquareSpan up = step(planes(k), envelope.fastest[k], span_[k + 1]);
    if (k > 0 && k + 1 < last && !(up.high > kStandstill)) {
      envelope.fastest[k] = balanced(planes(k), envelope.slowest[k], envelope.fastest[k], span_[k + 1]);
      up = step(planes(k), envelope.fastest[k], span_[k + 1]);
    }
    const SquareSpan down = step(planes(k), envelope.slowest[k], span_[k + 1]);
    const double fast = std::clamp(up.high, span_[k + 1].low, span_[k + 1].high);
    if (k + 1 < last && !(fast > kStandstill)) return blocked_at(k + 1, up);
    envelope.fastest.push_back(fast);
    envelope.slowest.push_back(std::clamp(std::max(down.low, span_[k + 1].low), 0.0, span_[k + 1].high));
  }
  envelope.fastest.back() = problem.b_end;
  envelope.slowest.back() = problem.b_end;
  return std::nullopt;
}

void EnvelopeSweeps::first_sweep(const Problem& problem) {
  sweep(problem, envelope_);
  for (int i = 0; i < kSlowings && envelope_.blocked; ++i) {
    for (std::size_t k = 1; k + 1 < at_.size(); ++k) at_[k] *= 0.25;
    sweep(problem, next_);
    if (!next_.blocked) std::swap(envelope_, next_);
  }
}

const RateEnvelope& EnvelopeSweeps::run(const Problem& problem) {
  at_.resize(problem.node_count());
  for (std::size_t k = 0; k < at_.size(); ++k) {
    const double from_start = problem.b_start + 2 * (problem.s[k] - problem.s.front());
    const double from_end = problem.b_end + 2 * (problem.s.back() - problem.s[k]);
    at_[k] = k == 0 || k + 1 == at_.size() ? capped(problem, k)
                                           : std::min({capped(problem, k), from_start, from_end, 4.0});
  }
  if (!bends(problem)) {
    sweep(problem, envelope_);
    return envelope_;
  }
  first_sweep(problem);
  for (int i = 0; i < kSweeps && !envelope_.blocked; ++i) {
    double change = 0;
    for (std::size_t k = 1; k + 1 < at_.size(); ++k) {
      const double to = std::max(envelope_.fastest[k], 1e-9);
      change = std::max(change, std::abs(to - at_[k]) / (to + at_[k]));
      at_[k] = to;
    }
    if (change < 1e-9) break;
    sweep(problem, next_);
    if (next_.blocked) break;
    std::swap(envelope_, next_);
  }
  return envelope_;
}

RateEnvelope rate_envelope(const Problem& problem) {
  EnvelopeSweeps sweeps;
  return sweeps.run(problem);
}

}  // namespace joulepath::nlp
