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
        affine_fit_(motion.plant()),
        by_node_(problem.node_count(), 0.0) {}

  PathSlopes all(const std::vector<double>& mandatory) {
    for (std::size_t k = 0; k < p_.segment_count(); ++k) add_segment(k);
    for (std::size_t k = 1; k + 1 < p_.node_count(); ++k) add_cap(k);
    keep_shares(mandatory);
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
  void add(std::size_t k, double fraction, const PlaceSlope& slope, const PathRates& rates,
           double turn_change);
  void keep_shares(const std::vector<double>& mandatory);
  void add_reversal(std::size_t k);

  const Problem& p_;
  const PathMotion& motion_;
  const Solution& solution_;
  bool posed_;  ///< laws depend on the pose
  AffineFit affine_fit_;
  PathSlopes slopes_{};
  std::vector<double> by_node_;  ///< derivatives by the place of each node along the path as it is
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
  PlaceSlope result{.s_m = segment_.s0 + std::clamp(original.fraction, kInset, 1 - kInset) * segment_.ds};
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
  by_node_[k] -= slopes_.lengths.back().by_length;
  by_node_[k + 1] += slopes_.lengths.back().by_length;
  const Interval<double> at = interval(segment_);
  const double first = segment_.limit_points[0].rates.turn_slope,
               middle = segment_.limit_points[1].rates.turn_slope,
               last = segment_.limit_points[2].rates.turn_slope;
  const auto take_point = [&](SegmentPoint& point, const auto& share) {
    const double bend_change = last - first + 4 * (point.fraction - 0.5) * (first - 2 * middle + last);
    add(k, point.fraction, at_point(point, share), point.rates, bend_change / segment_.ds);
  };
  for (std::size_t q = 0; q < kEnergyPoints; ++q)
    take_point(segment_.energy_points[q], [&] { return energy_share(segment_, at, q); });
  if (rows_.empty()) return;
  for (SegmentPoint& point : segment_.limit_points) take_point(point, [&] { return rows_share(at); });
}

/// A place between the nodes of segment k, which moves with them.
void Slopes::add(std::size_t k, double fraction, const PlaceSlope& slope, const PathRates& rates,
                 double turn_change) {
  slopes_.places.push_back(slope);
  double along = slope.by_curvature * rates.turn_slope + slope.by_curvature_slope * turn_change;
  if (posed_) {
    const double heading_rad = motion_.site(slope.s_m, 0.0).pose.heading_rad;
    along += rates.along * (slope.by_x_m * std::cos(heading_rad) + slope.by_y_m * std::sin(heading_rad)) +
             slope.by_heading_rad * rates.turn;
  }
  by_node_[k] += (1 - fraction) * along;
  by_node_[k + 1] += fraction * along;
}

/// d ln(cap)/d turn of a cap of the square of the rate.
double log_slope(const RateCap& cap, double turn) {
  if (cap.limit == "yaw_rate") return -2 / turn;
  return cap.limit == "lateral_acceleration" ? -1 / turn : 0.0;
}

/// The caps of a segment: at its ends, and at the places inside that may lower them.
struct SegmentCaps {
  struct Place {
    double fraction{}, s{};
    PathRates rates{};
    RateCap cap{};
  };
  SegmentCaps(const ProfileRequest& request, const PathMotion& motion, const Segment& segment) {
    const auto place_at = [&](double fraction, double s, const PathRates& rates) {
      return Place{fraction, s, rates, rate_cap(request, rates, s)};
    };
    ends = {place_at(0, segment.s0, segment.limit_points.front().rates),
            place_at(1, segment.s0 + segment.ds, segment.limit_points.back().rates)};
    CapsInside squares;
    for (std::size_t i = 0; i < inside.size(); ++i) {
      const double s = segment.s0 + kInsideSegment[i] * segment.ds;
      inside[i] = place_at(kInsideSegment[i], s, motion.rates(s));
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
  const auto add_place = [&](const SegmentCaps::Place& place, double share) {
    const double by_curvature = -y * cap * share * log_slope(place.cap, place.rates.turn);
    add(own == 0 ? k : k - 1, place.fraction, {.s_m = place.s, .by_curvature = by_curvature}, place.rates,
        0.0);
  };
  add_place(caps.source(own), 1.0);
  if (!caps.chord.lowest) return;
  add_place(caps.inside[*caps.chord.lowest], 1.0);
  add_place(caps.source(0), -caps.chord.share0);
  add_place(caps.source(1), caps.chord.share0 - 1);
}

/// Nodes keep their shares of the lengths between the mandatory ones (DraftSeries), not their material
/// points: a node moves by its share of what the whole part grows less what the part before it grows, and
/// with the mandatory nodes at both ends. Those at joints stay at theirs.
void Slopes::keep_shares(const std::vector<double>& mandatory) {
  const auto node_s = [&](std::size_t k) { return p_.segments[k].s0; };
  const double rounding_m = 1e-9 * mandatory.back();
  for (std::size_t first = 0, part = 0; part + 1 < mandatory.size(); ++part) {
    const double from = mandatory[part], to = mandatory[part + 1];
    std::size_t last = first + 1;
    while (last < p_.segment_count() && node_s(last) < to - rounding_m) ++last;
    double whole = 0, after = 0;
    for (std::size_t k = first + 1; k < last; ++k) {
      const double share = (node_s(k) - from) / (to - from);
      whole += share * by_node_[k];
      after += by_node_[k];
    }
    by_node_[first] += after - whole;
    by_node_[last] += whole;
    for (std::size_t k = first; k < last; ++k) {
      if (k > first) after -= by_node_[k];  // of the nodes behind segment k
      slopes_.lengths[k].by_length += whole - after;
    }
    first = last;
  }
}

/// A wheel reverses where curvature is 1 / half track: this place moves with the curvature.
void Slopes::add_reversal(std::size_t k) {
  const Segment &before = p_.segments[k - 1], &after = p_.segments[k];
  if (before.limit_points.back().site.wheel_direction == after.limit_points.front().site.wheel_direction)
    return;
  const double turn_slope = after.limit_points.front().rates.turn_slope;
  if (std::abs(turn_slope) < kStep) return;  // the curve only touches that curvature
  slopes_.places.push_back({.s_m = after.s0, .by_curvature = -by_node_[k] / turn_slope});
}

}  // namespace

PathSlopes lagrangian_slopes(const Problem& problem, const PathMotion& motion, const Solution& solution,
                             const std::vector<double>& mandatory) {
  return Slopes(problem, motion, solution).all(mandatory);
}

}  // namespace joulepath::nlp
