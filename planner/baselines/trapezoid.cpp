#include "planner/baselines/trapezoid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "planner/baselines/finish.hpp"
#include "planner/baselines/pattern_search.hpp"
#include "planner/nlp/forward_backward.hpp"
#include "planner/nlp/grid.hpp"

namespace joulepath {
namespace {

constexpr std::size_t kNodes = 300;

double finite_or(double value, double otherwise) { return std::isfinite(value) ? value : otherwise; }

}  // namespace

TrapezoidFamily::TrapezoidFamily(const ProfileRequest& request) : request_(&request) {
  const PathMotion motion = path_motion(request);
  problem_ = nlp::transcribe(request, motion, nlp::make_grid(motion, request, kNodes), {}, nullptr);
  const Limits& limits = request.limits;
  const bool turn = is_turn(request.piece);
  most_acceleration_ =
      finite_or(turn ? limits.yaw_acceleration_rad_s2 : limits.acceleration_m_s2, kUnlimited);
  most_deceleration_ =
      finite_or(turn ? limits.yaw_acceleration_rad_s2 : limits.deceleration_m_s2, kUnlimited);
}

bool TrapezoidFamily::curves() const {
  if (is_turn(request_->piece) || !std::isfinite(request_->limits.yaw_acceleration_rad_s2)) return false;
  const auto changes = [](const nlp::SegmentPoint& point) { return point.rates.turn_slope != 0; };
  return std::any_of(problem_.segments.begin(), problem_.segments.end(), [&](const nlp::Segment& segment) {
    return std::any_of(segment.limit_points.begin(), segment.limit_points.end(), changes);
  });
}

TrapezoidFamily::Clip TrapezoidFamily::clip(double curve_share) const {
  const double limit = request_->limits.yaw_acceleration_rad_s2;
  Clip clip{problem_.s, {}, std::vector<std::size_t>(problem_.segment_count())};
  std::iota(clip.segment.begin(), clip.segment.end(), std::size_t{0});
  for (const nlp::RateCap& cap : problem_.cap) clip.cap.push_back(std::min(cap.squared, 1e6));
  for (std::size_t k = 0; k < problem_.segment_count(); ++k)
    for (const nlp::SegmentPoint& point : problem_.segments[k].limit_points) {
      const double slope = std::abs(point.rates.turn_slope);
      if (!(slope > 0)) continue;
      for (double* cap : {&clip.cap[k], &clip.cap[k + 1]}) *cap = std::min(*cap, curve_share * limit / slope);
    }
  return clip;
}

double TrapezoidFamily::steepest(std::size_t segment, double ds, double b, bool accelerates) const {
  const double limit = request_->limits.yaw_acceleration_rad_s2;
  double least = kNoLimit;
  for (const nlp::SegmentPoint& point : problem_.segments[segment].limit_points) {
    const double turn = std::abs(point.rates.turn), slope = std::abs(point.rates.turn_slope);
    if (!(turn > 0)) continue;
    // b is the smaller square of the two ends: the larger one counts where both add up.
    const bool winds = point.rates.turn * point.rates.turn_slope >= 0;
    const double most = winds == accelerates ? std::max(0.0, limit - slope * b) / (turn + 2 * ds * slope)
                                             : (limit + slope * b) / turn;
    least = std::min(least, most);
  }
  return least;
}

std::vector<double> TrapezoidFamily::squares_on(const Clip& clip, const TrapezoidSettings& settings) const {
  const std::vector<double>& s = clip.s;
  const double start = problem_.b_start, end = problem_.b_end, length = s.back();
  const double up = 2 * settings.acceleration, down = 2 * settings.deceleration;
  std::vector<double> b(s.size());
  for (std::size_t k = 0; k < s.size(); ++k) {
    // A start faster than the cruise is braked off, an end faster than it is run up to.
    const double cruise =
        std::max({settings.rate * settings.rate, start - down * s[k], end - up * (length - s[k])});
    b[k] = std::min(clip.cap[k], cruise);
  }
  b.front() = std::min(b.front(), start);
  b.back() = std::min(b.back(), end);
  const auto gain = [&](std::size_t k, double square, double slope, bool accelerates) {
    const double ds = s[k + 1] - s[k];
    return std::min(slope, 2 * steepest(clip.segment[k], ds, square, accelerates)) * ds;
  };
  for (std::size_t k = 0; k + 1 < s.size(); ++k)
    b[k + 1] = std::min(b[k + 1], b[k] + gain(k, b[k], up, true));
  for (std::size_t k = s.size() - 1; k-- > 0;)
    b[k] = std::min(b[k], b[k + 1] + gain(k, b[k + 1], down, false));
  return b;
}

std::optional<std::vector<double>> TrapezoidFamily::squares(const TrapezoidSettings& settings) const {
  std::vector<double> b = squares_on(clip(settings.curve_share), settings);
  constexpr double kRounding = 1e-9;
  if (b.front() < problem_.b_start - kRounding || b.back() < problem_.b_end - kRounding) return std::nullopt;
  for (std::size_t k = 1; k + 1 < b.size(); ++k)
    if (!(b[k] > 0)) return std::nullopt;
  return b;
}

double TrapezoidFamily::duration_s(const std::vector<double>& b) const {
  return nlp::duration_of(problem_, b);
}

double TrapezoidFamily::energy_J(const std::vector<double>& b) const {
  constexpr double kTolerance = 2e-5;
  double sum_J = 0;
  for (std::size_t k = 0; k < problem_.segment_count(); ++k) {
    const nlp::Interval<double> interval = nlp::plain_interval(problem_.segments[k], b[k], b[k + 1]);
    for (std::size_t i = problem_.first_row[k]; i < problem_.first_row[k + 1]; ++i) {
      const nlp::ActiveRow& row = problem_.rows[i];
      const double value = nlp::evaluate_row(problem_, row, interval);
      if (value > row.bounds.high + kTolerance * std::abs(row.bounds.high) ||
          value < row.bounds.low - kTolerance * std::abs(row.bounds.low))
        return kNoLimit;
    }
    sum_J += nlp::kept_energy_J(interval);
  }
  return sum_J;
}

double TrapezoidFamily::least_duration_s() const {
  const nlp::RateEnvelope envelope = nlp::rate_envelope(problem_);
  return envelope.blocked ? kNoLimit : duration_s(envelope.fastest);
}

std::optional<double> TrapezoidFamily::rate_for(double acceleration, double deceleration, double curve_share,
                                                double duration_s) const {
  const Clip clipped = clip(curve_share);
  const auto slow = [&](double rate) {
    return this->duration_s(squares_on(clipped, {rate, acceleration, deceleration, curve_share})) >
           duration_s;
  };
  double high = std::sqrt(std::min(*std::max_element(clipped.cap.begin(), clipped.cap.end()),
                                   std::max(problem_.b_start, problem_.b_end) +
                                       2 * std::max(acceleration, deceleration) * problem_.s.back()));
  // Twice over: an exact deadline, met to rounding, is met.
  const auto fastest = squares({high, acceleration, deceleration, curve_share});
  if (!fastest) return std::nullopt;
  const double least_s = this->duration_s(*fastest);
  if (least_s > duration_s * (1 + 1e-9)) return std::nullopt;
  double low = 0.0;
  for (int i = 0; i < 60 && high - low > 1e-13 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (slow(middle) ? low : high) = middle;
  }
  return high;
}

Profile TrapezoidFamily::profile(const TrapezoidSettings& settings) const {
  const double up = 2 * settings.acceleration, down = 2 * settings.deceleration;
  const double cruise = settings.rate * settings.rate, length = problem_.s.back();
  const std::array<double, 3> corners{(cruise - problem_.b_start) / up,
                                      length - (cruise - problem_.b_end) / down,
                                      (problem_.b_end - problem_.b_start + down * length) / (up + down)};
  Clip fine = clip(settings.curve_share);
  std::vector<double>&s = fine.s, &cap = fine.cap;
  for (double corner : corners) {
    const auto after = std::upper_bound(s.begin(), s.end(), corner);
    if (after == s.begin() || after == s.end()) continue;
    const auto k = after - s.begin();
    const double before_s = *(after - 1), gap = *after - before_s;
    if (corner - before_s < 1e-6 * gap || *after - corner < 1e-6 * gap) continue;
    const double share = (corner - before_s) / gap;
    const double cap_here =
        (1 - share) * cap[static_cast<std::size_t>(k - 1)] + share * cap[static_cast<std::size_t>(k)];
    s.insert(s.begin() + k, corner);
    cap.insert(cap.begin() + k, cap_here);
    fine.segment.insert(fine.segment.begin() + k, fine.segment[static_cast<std::size_t>(k - 1)]);
  }
  return profile_from_squares(s, squares_on(fine, settings));
}

std::map<std::string, double> TrapezoidFamily::parameters(const TrapezoidSettings& settings) const {
  if (is_turn(request_->piece))
    return {{"yaw_rate_rad_s", settings.rate},
            {"yaw_acceleration_rad_s2", settings.acceleration},
            {"yaw_deceleration_rad_s2", settings.deceleration}};
  std::map<std::string, double> found{{"speed_m_s", settings.rate},
                                      {"acceleration_m_s2", settings.acceleration},
                                      {"deceleration_m_s2", settings.deceleration}};
  if (settings.curve_share < 1) found["yaw_acceleration_share"] = settings.curve_share;
  return found;
}

namespace {

/// Shares of the yaw acceleration that a change of curvature may use.
constexpr std::array<double, 5> kShares{1.0, 0.9, 0.75, 0.5, 0.25};

std::size_t share_count(const TrapezoidFamily& family) { return family.curves() ? kShares.size() : 1; }

/// Makes the executable profile take its time exactly: the corners' nodes changed it a little.
BaselineResult finish_trapezoid(const ProfileRequest& request, const TrapezoidFamily& family,
                                const char* name, TrapezoidSettings settings, double duration_s) {
  const auto excess_s = [&](double rate) {
    TrapezoidSettings trial = settings;
    trial.rate = rate;
    return family.profile(trial).time_s.back() - duration_s;
  };
  double low = settings.rate * (1 - 1e-2), high = settings.rate * (1 + 1e-2);
  if (excess_s(low) > 0 && excess_s(high) < 0) {
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (low + high);
      (excess_s(middle) > 0 ? low : high) = middle;
    }
    settings.rate = high;
  }
  return finish_baseline(request, name, family.profile(settings), duration_s, family.parameters(settings));
}

BaselineResult no_trapezoid(const char* name, const TrapezoidFamily& family, double duration_s,
                            const char* otherwise) {
  constexpr double kNearly = 1e-3;
  const double least_s = family.least_duration_s();
  if (!(duration_s <= least_s * (1 + kNearly))) return no_baseline(name, otherwise);
  return no_baseline(name, "the plan's time is the least possible: no other profile makes it");
}

/// Of one share, the settings that cost least; nothing where none keeps the rows.
std::optional<TrapezoidSettings> tuned(const TrapezoidFamily& family, double share, double duration_s) {
  const auto settings_at = [&](double up, double down) -> std::optional<TrapezoidSettings> {
    const double acceleration = family.most_acceleration() * std::exp(up);
    const double deceleration = family.most_deceleration() * std::exp(down);
    const auto rate = family.rate_for(acceleration, deceleration, share, duration_s);
    if (!rate) return std::nullopt;
    return TrapezoidSettings{*rate, acceleration, deceleration, share};
  };
  const PatternMinimum best = pattern_search([&](double up, double down) {
    const auto settings = settings_at(up, down);
    return settings ? family.energy_J(*family.squares(*settings)) : kNoLimit;
  });
  return std::isfinite(best.value) ? settings_at(best.x, best.y) : std::nullopt;
}

}  // namespace

BaselineResult trapezoid_max_acceleration(const ProfileRequest& request, double duration_s) {
  constexpr const char* kName = "trapezoid_max_acceleration";
  const TrapezoidFamily family(request);
  const double up = family.most_acceleration(), down = family.most_deceleration();
  std::optional<BaselineResult> best;
  for (std::size_t i = 0; i < share_count(family); ++i) {
    const std::optional<double> rate = family.rate_for(up, down, kShares[i], duration_s);
    if (!rate) continue;
    BaselineResult result =
        finish_trapezoid(request, family, kName, {*rate, up, down, kShares[i]}, duration_s);
    const bool better = best && result.feasible && (!best->feasible || result.energy_J < best->energy_J);
    if (!best || better) best = std::move(result);
  }
  if (best) return std::move(*best);
  return no_trapezoid(kName, family, duration_s, "cannot make the time with the local speed limits");
}

BaselineResult trapezoid_best_tuned(const ProfileRequest& request, double duration_s) {
  constexpr const char* kName = "trapezoid_best_tuned";
  const TrapezoidFamily family(request);
  // The largest accelerations are among what is tuned, judged on the exact path as all are at the end.
  std::optional<BaselineResult> best;
  BaselineResult largest = trapezoid_max_acceleration(request, duration_s);
  largest.name = kName;
  if (largest.feasible) best = std::move(largest);
  for (std::size_t i = 0; i < share_count(family); ++i) {
    const auto settings = tuned(family, kShares[i], duration_s);
    if (!settings) continue;
    BaselineResult result = finish_trapezoid(request, family, kName, *settings, duration_s);
    const bool better = best && result.feasible && (!best->feasible || result.energy_J < best->energy_J);
    if (!best || better) best = std::move(result);
  }
  if (best) return std::move(*best);
  return no_trapezoid(kName, family, duration_s, "no trapezoid makes the time within the limits");
}

}  // namespace joulepath
