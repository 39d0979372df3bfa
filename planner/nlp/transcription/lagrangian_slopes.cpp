#include "planner/nlp/transcription/lagrangian_slopes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/nlp/transcription/affine_fit.hpp"
#include "planner/nlp/transcription/chord_of_caps.hpp"

namespace joulepath::nlp {
namespace {

/// Multipliers that change the cost by less than this share are those of inactive constraints.
constexpr double kActive = 1e-8;
constexpr double kStep = 1e-4;  ///< of differences: costs are low polynomials of curvature and length

class Slopes {
 public:
  Slopes(const Problem& problem, const PathMotion& motion, const Solution& solution)
      : p_(problem),
        motion_(motion),
        solution_(solution),
        posed_(!motion.plant().effects.empty()),
        affine_fit_(motion.plant()) {}

  PathSlopes all() {
    for (std::size_t k = 0; k < p_.segment_count(); ++k) add_segment(k);
    for (std::size_t k = 1; k + 1 < p_.node_count(); ++k) add_cap(k);
    for (std::size_t k = 1; k < p_.segment_count(); ++k) add_reversal(k);
    return std::move(slopes_);
  }

 private:
  Interval<double> interval(const Segment& segment) const {
    return plain_interval(segment, solution_.b[k_], solution_.b[k_ + 1]);
  }
  bool active(std::size_t row) const {
    const Bounds& bounds = p_.rows[row].bounds;
    const double y = solution_.row_multiplier[row], bound = y > 0 ? bounds.high : bounds.low;
    return std::abs(y * bound) > kActive * std::abs(solution_.objective);
  }
  double rows_share(const Interval<double>& at) const {
    double sum = 0;
    for (const std::size_t row : rows_)
      sum += solution_.row_multiplier[row] * evaluate_row(p_, p_.rows[row], at);
    return sum;
  }
  /// A quadrature point's share of the Lagrangian.
  double energy_share(const Segment& segment, const Interval<double>& at, std::size_t q) const {
    const auto load = wheel_loads(segment, segment.energy_points[q], at.at_energy_point(q));
    return 0.5 * at.dt * (weight_[0] * load.left.power_W + weight_[1] * load.right.power_W);
  }
  double share(const Segment& segment) const {
    const Interval<double> at = interval(segment);
    double sum = (p_.time_weight_W + solution_.price_W) * at.dt + rows_share(at);
    for (std::size_t q = 0; q < kEnergyPoints; ++q) sum += energy_share(segment, at, q);
    return sum;
  }

  void add_segment(std::size_t k);
  void take(std::size_t k);
  template <class Share>
  PlaceSlope at_point(SegmentPoint& point, const Share& share);
  double by_length();
  void add_cap(std::size_t k);
  void add_reversal(std::size_t k);

  const Problem& p_;
  const PathMotion& motion_;
  const Solution& solution_;
  bool posed_;  ///< laws depend on the pose
  AffineFit affine_fit_;
  PathSlopes slopes_{};
  // Of the present segment:
  std::size_t k_{};
  Segment segment_{};
  std::array<double, 2> weight_{};
  std::vector<std::size_t> rows_{};
};

void Slopes::take(std::size_t k) {
  k_ = k;
  segment_ = p_.segments[k];
  for (std::size_t c = 0; c < 2; ++c) {
    const std::size_t channel = p_.channels == 1 ? 0 : c;
    const double recovered = p_.channels > 0 ? solution_.recovery_multiplier[k * p_.channels + channel] : 0.0;
    weight_[c] = p_.energy_weight - recovered;
  }
  rows_.clear();
  for (std::size_t row = p_.first_row[k]; row < p_.first_row[k + 1]; ++row)
    if (active(row)) rows_.push_back(row);
}

/// Central differences of a share by what a point's law depends on; wheels keep their directions.
template <class Share>
PlaceSlope Slopes::at_point(SegmentPoint& point, const Share& share) {
  const SegmentPoint original = point;
  const auto slope = [&](auto&& move, double step) {
    double value[2];
    for (int side = 0; side < 2; ++side) {
      point = original;
      move(point, side == 0 ? -step : step);
      if (posed_)
        point.site.course = course_of(motion_.plant().robot.geometry, point.rates.along, point.rates.turn);
      if (point.affine) (void)affine_fit_.at(point.rates, point.site, point.wheel);
      value[side] = share();
    }
    point = original;
    return (value[1] - value[0]) / (2 * step);
  };
  PlaceSlope result{.s_m = segment_.s0 + original.fraction * segment_.ds};
  const double bend = kStep * (1 + std::abs(original.rates.turn)),
               change = kStep * (1 + std::abs(original.rates.turn_slope));
  result.by_curvature = slope([](SegmentPoint& p, double d) { p.rates.turn += d; }, bend);
  result.by_curvature_slope = slope([](SegmentPoint& p, double d) { p.rates.turn_slope += d; }, change);
  if (!posed_) return result;
  result.by_x_m = slope([](SegmentPoint& p, double d) { p.site.pose.x_m += d; }, kStep);
  result.by_y_m = slope([](SegmentPoint& p, double d) { p.site.pose.y_m += d; }, kStep);
  result.by_heading_rad = slope([](SegmentPoint& p, double d) { p.site.pose.heading_rad += d; }, kStep);
  return result;
}

double Slopes::by_length() {
  const double ds = segment_.ds, step = kStep * ds;
  segment_.ds = ds + step;
  const double longer = share(segment_);
  segment_.ds = ds - step;
  const double shorter = share(segment_);
  segment_.ds = ds;
  return (longer - shorter) / (2 * step);
}

void Slopes::add_segment(std::size_t k) {
  take(k);
  slopes_.lengths.push_back({segment_.s0, segment_.s0 + segment_.ds, by_length()});
  const Interval<double> at = interval(segment_);
  for (std::size_t q = 0; q < kEnergyPoints; ++q)
    slopes_.places.push_back(
        at_point(segment_.energy_points[q], [&] { return energy_share(segment_, at, q); }));
  if (rows_.empty()) return;
  for (SegmentPoint& point : segment_.limit_points)
    slopes_.places.push_back(at_point(point, [&] { return rows_share(at); }));
}

/// d ln(cap)/d turn of a cap of the square of the rate.
double log_slope(const RateCap& cap, double turn) {
  if (cap.limit == "yaw_rate") return -2 / turn;
  return cap.limit == "lateral_acceleration" ? -1 / turn : 0.0;
}

/// The caps of a segment: at its ends, and at the places inside that may lower them.
struct SegmentCaps {
  struct Place {
    double s{}, turn{};
    RateCap cap{};
  };
  SegmentCaps(const ProfileRequest& request, const PathMotion& motion, const Segment& segment) {
    const auto place_at = [&](double s, const PathRates& rates) {
      return Place{s, rates.turn, rate_cap(request, rates, s)};
    };
    ends = {place_at(segment.s0, segment.limit_points.front().rates),
            place_at(segment.s0 + segment.ds, segment.limit_points.back().rates)};
    CapsInside squares;
    for (std::size_t i = 0; i < inside.size(); ++i) {
      const double s = segment.s0 + kInsideSegment[i] * segment.ds;
      inside[i] = place_at(s, motion.rates(s));
      squares[i] = inside[i].cap.squared;
    }
    chord = chord_of_caps(ends[0].cap.squared, ends[1].cap.squared, squares);
  }
  /// The place whose cap bounds an end before the chord is lowered.
  const Place& source(std::size_t end) const {
    return chord.bound[end] ? inside[*chord.bound[end]] : ends[end];
  }

  std::array<Place, 2> ends{};
  std::array<Place, kInsideSegment.size()> inside{};
  ChordOfCaps chord{};
};

/// The cap of a node is that of lower_caps: the least that the chords of its two segments leave it.
void Slopes::add_cap(std::size_t k) {
  const double y = solution_.cap_multiplier[k], cap = p_.cap[k].squared;
  if (!(std::isfinite(cap) && y * cap > kActive * std::abs(solution_.objective))) return;
  const SegmentCaps before(*p_.request, motion_, p_.segments[k - 1]),
      after(*p_.request, motion_, p_.segments[k]);
  const std::size_t own = after.chord.squared[0] < before.chord.squared[1] ? 0 : 1;
  const SegmentCaps& caps = own == 0 ? after : before;
  const auto add = [&](const SegmentCaps::Place& place, double share) {
    slopes_.places.push_back(
        {.s_m = place.s, .by_curvature = -y * cap * share * log_slope(place.cap, place.turn)});
  };
  add(caps.source(own), 1.0);
  if (!caps.chord.lowest) return;
  add(caps.inside[*caps.chord.lowest], 1.0);
  add(caps.source(0), -caps.chord.share0);
  add(caps.source(1), caps.chord.share0 - 1);
}

/// A wheel reverses where curvature is 1 / half track. The place moves with the curvature, and both sides of
/// it have different laws.
void Slopes::add_reversal(std::size_t k) {
  const Segment &before = p_.segments[k - 1], &after = p_.segments[k];
  if (before.limit_points.back().site.wheel_direction == after.limit_points.front().site.wheel_direction)
    return;
  const double turn_slope = after.limit_points.front().rates.turn_slope;
  if (std::abs(turn_slope) < kStep) return;  // the curve only touches that curvature
  double by_place = 0;
  for (const std::size_t segment : {k - 1, k}) {
    take(segment);
    const bool first = segment == k;
    by_place += (first ? -1 : 1) * by_length();
    const Interval<double> at = interval(segment_);
    const auto moved = [&](SegmentPoint& point, const auto& share) {
      const PlaceSlope slope = at_point(point, share);
      const double step = kStep * segment_.ds;
      const PathRates low = motion_.rates(slope.s_m - step), high = motion_.rates(slope.s_m + step);
      const double along = first ? 1 - point.fraction : point.fraction;
      by_place += along *
                  (slope.by_curvature * (high.turn - low.turn) +
                   slope.by_curvature_slope * (high.turn_slope - low.turn_slope)) /
                  (2 * step);
    };
    for (std::size_t q = 0; q < kEnergyPoints; ++q)
      moved(segment_.energy_points[q], [&] { return energy_share(segment_, at, q); });
  }
  slopes_.places.push_back({.s_m = after.s0, .by_curvature = -by_place / turn_slope});
}

}  // namespace

PathSlopes lagrangian_slopes(const Problem& problem, const PathMotion& motion, const Solution& solution) {
  return Slopes(problem, motion, solution).all();
}

}  // namespace joulepath::nlp
