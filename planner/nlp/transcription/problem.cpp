#include "planner/nlp/transcription/problem.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "planner/motion/path_motion.hpp"
#include "planner/nlp/transcription/affine_fit.hpp"
#include "planner/nlp/transcription/chord_of_caps.hpp"
#include "planner/nlp/transcription/grid.hpp"
#include "planner/nlp/transcription/row_selection.hpp"
#include "planner/values/profile.hpp"

namespace joulepath::nlp {
namespace {

template <class AnyRows, class Function, std::size_t... I>
void for_term(std::size_t index, AnyRows& terms, Function&& function, std::index_sequence<I...>) {
  ((I == index ? (function(std::get<I>(terms)), 0) : 0), ...);
}

template <class AnyInterval>
auto evaluate(const Problem& problem, const ActiveRow& row, const AnyInterval& interval) {
  typename AnyInterval::Real value{};
  for_term(
      row.term, problem.terms, [&](const auto& term) { value = term(interval, row.row); },
      std::make_index_sequence<std::tuple_size_v<Rows>>());
  return value;
}

/// Share of the segment's length covered after a share tau of its time, at constant acceleration.
double length_share(double u0, double u1, double tau) {
  return u0 + u1 > 0 ? (2 * u0 * tau + (u1 - u0) * tau * tau) / (u0 + u1) : tau;
}

/// Its inverse: share of the time after a share of the length.
double time_share(double u0, double u1, double share) {
  const double u = std::sqrt(std::max(0.0, u0 * u0 + share * (u1 * u1 - u0 * u0)));
  return u0 + u > 0 ? share * (u0 + u1) / (u0 + u) : share;
}

class Transcriber {
 public:
  Transcriber(const ProfileRequest& request, const PathMotion& motion, const Profile* previous)
      : request_(request), motion_(motion), previous_(previous), affine_fit_(request.plant) {}

  /// The segments of a grid.
  std::vector<Segment> segments(const std::vector<double>& s) {
    std::vector<Segment> all;
    all.reserve(s.size());
    double before = rate(s.front());
    for (std::size_t k = 0; k + 1 < s.size(); ++k) {
      const double after = rate(s[k + 1]);
      all.push_back(segment(s[k], s[k + 1], before, after));
      before = after;
    }
    return all;
  }
  /// One of them.
  Segment segment(double s0, double s1) { return segment(s0, s1, rate(s0), rate(s1)); }

 private:
  Segment segment(double s0, double s1, double u0, double u1) {
    Segment segment{.s0 = s0, .ds = s1 - s0, .plant = &request_.plant};
    constexpr std::array<double, kLimitPoints> fractions{0.0, 0.5, 1.0};
    for (std::size_t i = 0; i < kLimitPoints; ++i)
      segment.limit_points[i] = point(segment, fractions[i], time_at(segment, u0, u1, fractions[i]));
    for (std::size_t q = 0; q < kEnergyPoints; ++q) {
      const double tau = kEnergyTimes[q];
      segment.energy_points[q] = point(segment, length_at(segment, u0, u1, tau), tau);
    }
    return segment;
  }

  double rate(double s) const {
    if (s <= 0) return request_.start_rate;
    if (s >= motion_.length()) return request_.end_rate;
    if (previous_) return previous_->at_s(s).rate;
    return reference_rate(request_, motion_.length(), s, rate_cap_squared(request_, motion_.rates(s), s));
  }

  /// Share of the length after a share of the time, in the previous profile.
  double length_at(const Segment& segment, double u0, double u1, double tau) const {
    if (!previous_) return length_share(u0, u1, tau);
    const auto [from_s, to_s] = times(segment);
    return (previous_->at_time(from_s + tau * (to_s - from_s)).s - segment.s0) / segment.ds;
  }
  double time_at(const Segment& segment, double u0, double u1, double share) const {
    if (share == 0 || share == 1) return share;
    if (!previous_) return time_share(u0, u1, share);
    const auto [from_s, to_s] = times(segment);
    return (previous_->at_s(segment.s0 + share * segment.ds).time_s - from_s) / (to_s - from_s);
  }
  std::pair<double, double> times(const Segment& segment) const {
    return {previous_->at_s(segment.s0).time_s, previous_->at_s(segment.s0 + segment.ds).time_s};
  }

  SegmentPoint point(const Segment& segment, double fraction, double time_share) {
    const double s = segment.s0 + segment.ds * std::clamp(fraction, kInset, 1 - kInset);
    const double time_s = previous_ ? previous_->at_s(s).time_s : 0.0;
    const PathMotion::Place place = motion_.laws(s, time_s);
    SegmentPoint result{
        .fraction = fraction, .time_share = time_share, .rates = place.rates, .site = place.site};
    result.affine = affine_fit_.at(result.rates, result.site, result.wheel);
    return result;
  }

  const ProfileRequest& request_;
  const PathMotion& motion_;
  const Profile* previous_{};
  AffineFit affine_fit_;
};

}  // namespace

double factor_for(const std::vector<Tightening>& tightenings, std::string_view limit, double from,
                  double to) {
  double factor = 1.0;
  for (const Tightening& t : tightenings)
    if (t.limit == limit && t.from < to && t.to > from) factor *= t.factor;
  return factor;
}

Segment make_segment(const ProfileRequest& request, const PathMotion& motion, double s0, double s1,
                     const Profile* previous) {
  return Transcriber(request, motion, previous).segment(s0, s1);
}

void lower_caps(const ProfileRequest& request, const PathMotion& motion, const Segment& segment,
                const std::vector<Tightening>& tightenings, RateCap& cap0, RateCap& cap1) {
  const double s1 = segment.s0 + segment.ds;
  const auto capped_at = [&](double f, const PathRates& rates) {
    const double s = segment.s0 + segment.ds * std::clamp(f, kInset, 1 - kInset);
    RateCap cap = rate_cap(request, rates, s);
    const double factor = factor_for(tightenings, cap.limit, segment.s0, s1);
    cap.squared *= cap.limit == "lateral_acceleration" ? factor : factor * factor;
    return cap;
  };
  const auto capped = [&](double f) {
    return capped_at(f, motion.rates(segment.s0 + segment.ds * std::clamp(f, kInset, 1 - kInset)));
  };
  const auto lower = [](RateCap& cap, const RateCap& to) {
    if (to.squared < cap.squared) cap = to;
  };
  const PathRates first = segment.limit_points[0].rates, last = segment.limit_points[2].rates;
  const RateCap at0 = capped_at(0, first), at1 = capped_at(1, last);
  lower(cap0, at0);
  lower(cap1, at1);
  if (first.turn == last.turn && first.turn_slope == 0 && last.turn_slope == 0) return;
  std::array<RateCap, kInsideSegment.size()> inside;
  CapsInside squares;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    inside[i] = capped(kInsideSegment[i]);
    squares[i] = inside[i].squared;
  }
  const ChordOfCaps chord = chord_of_caps(at0.squared, at1.squared, squares);
  const auto lower_end = [&](RateCap& cap, std::size_t end) {
    if (const auto place = chord.lowest ? chord.lowest : chord.bound[end])
      lower(cap, {chord.squared[end], inside[*place].limit});
  };
  lower_end(cap0, 0);
  lower_end(cap1, 1);
}

void set_objective(Problem& problem) {
  const ProfileRequest& request = *problem.request;
  const PowerSupply& supply = request.plant.robot.power;
  const TimeGoal& time = request.time;
  const bool minimum_time = time.mode == TimeMode::minimum_time;
  problem.channels = 0;
  problem.recovery_weight = 1 - supply.regeneration_efficiency;
  if (problem.recovery_weight > 0 && !minimum_time)
    problem.channels = supply.sharing == PowerSharing::bus ? 1 : 2;
  problem.energy_weight = minimum_time ? 0.0 : 1.0;
  problem.time_weight_W =
      minimum_time ? 1.0 : supply.standby_W + (time.mode == TimeMode::time_price ? time.price_W : 0.0);
  problem.duration_row = DurationRow::none;
  problem.duration_s = kNoLimit;
  if (minimum_time || time.mode == TimeMode::free_time || std::isinf(time.duration_s)) return;
  problem.duration_s = time.duration_s;
  problem.duration_row = time.mode == TimeMode::fixed_time ? DurationRow::equal : DurationRow::at_most;
}

Problem transcribe(const ProfileRequest& request, const PathMotion& motion, const std::vector<double>& s,
                   const std::vector<Tightening>& tightenings, const Profile* previous) {
  Problem problem{.request = &request,
                  .s = s,
                  .cap = std::vector<RateCap>(s.size()),
                  .b_start = request.start_rate * request.start_rate,
                  .b_end = request.end_rate * request.end_rate,
                  .terms = rows_for(request.limits)};
  Transcriber transcriber(request, motion, previous);
  problem.segments = transcriber.segments(s);
  for (std::size_t k = 0; k + 1 < s.size(); ++k)
    lower_caps(request, motion, problem.segments[k], tightenings, problem.cap[k], problem.cap[k + 1]);
  std::vector<double> squares;
  select_rows(problem, tightenings, squares);
  set_objective(problem);
  return problem;
}

Jet evaluate_row(const Problem& problem, const ActiveRow& row, const Interval<Jet>& interval) {
  return evaluate(problem, row, interval);
}

double evaluate_row(const Problem& problem, const ActiveRow& row, const Interval<double>& interval) {
  return evaluate(problem, row, interval);
}

JerkJet evaluate_row(const Problem& problem, const ActiveRow& row, const JerkInterval<JerkJet>& interval) {
  return evaluate(problem, row, interval);
}

double duration_of(const Problem& problem, const std::vector<double>& b) {
  double sum_s = 0;
  for (std::size_t k = 0; k < problem.segment_count(); ++k)
    sum_s += plain_interval(problem.segments[k], b[k], b[k + 1]).dt;
  return sum_s;
}

}  // namespace joulepath::nlp
