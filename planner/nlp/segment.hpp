#pragma once

#include <array>
#include <cmath>

#include "planner/nlp/jet.hpp"
#include "planner/nlp/range.hpp"
#include "planner/profile.hpp"

namespace joulepath::nlp {

/// constant + of_a a + of_b b + of_u u, with u the rate, b = u^2, a the acceleration.
struct Affine {
  double constant{};
  double of_a{};
  double of_b{};
  double of_u{};

  template <class Real>
  Real operator()(const Real& a, const Real& b, const Real& u) const {
    return constant + of_a * a + of_b * b + of_u * u;
  }
};

/// A wheel's current, voltage and contact force where they are affine: with every effect but those that
/// bend the law (gear loss, driver drop, Stribeck friction).
struct AffineWheel {
  Affine current_A{};
  Affine voltage_V{};
  Affine force_N{};
};

template <class Real>
struct WheelLoad {
  Real current_A{};
  Real voltage_V{};
  Real force_N{};
};

/// A place within a segment with what the model needs there.
struct SegmentPoint {
  double fraction{};  ///< of the segment's length
  PathRates rates{};
  Site site{};
  bool affine{};
  Sided<AffineWheel> wheel{};
};

inline constexpr std::size_t kLimitPoints = 3;   ///< both ends, seen from the inside, and the middle
inline constexpr std::size_t kEnergyPoints = 2;  ///< Gauss-Legendre in time
inline constexpr std::array<double, kEnergyPoints> kEnergyTimes{0.21132486540518712, 0.78867513459481288};

/// The stretch between two neighbouring nodes.
struct Segment {
  double s0{};
  double ds{};
  const Plant* plant{};
  std::array<SegmentPoint, kLimitPoints> limit_points{};
  std::array<SegmentPoint, kEnergyPoints> energy_points{};
};

/// Two neighbouring nodes as a term sees them: squares of the rate and what follows from them.
template <class Real>
struct Interval {
  const Segment& segment;
  Real b0{}, b1{};  ///< rate^2
  Real u0{}, u1{};  ///< rate
  Real a{};         ///< (b1 - b0)/(2 ds), constant in the segment
  Real dt{};        ///< 2 ds/(u0 + u1), exact
};

/// Wheel loads at a point for given acceleration, rate squared, rate.
template <class Real>
Sided<WheelLoad<Real>> wheel_loads(const Segment& segment, const SegmentPoint& point, const Real& a,
                                   const Real& b, const Real& u) {
  Sided<WheelLoad<Real>> loads;
  if (point.affine) {
    for (Side side : kSides) {
      const AffineWheel& wheel = point.wheel[side];
      loads[side] = {wheel.current_A(a, b, u), wheel.voltage_V(a, b, u), wheel.force_N(a, b, u)};
    }
    return loads;
  }
  if constexpr (std::is_same_v<Real, Range>) {
    constexpr Range anything{-kNoLimit, kNoLimit};
    return {{anything, anything, anything}, {anything, anything, anything}};
  } else {
    const Sided<WheelState<Real>> wheels =
        operating_point(*segment.plant, PathMotion::body_motion(point.rates, u, a), point.site);
    for (Side side : kSides)
      loads[side] = {wheels[side].current_A, wheels[side].voltage_V, wheels[side].contact_force_N};
    return loads;
  }
}

/// Square of the rate and rate at one of the limit points.
template <class Real>
struct PointRate {
  Real b{}, u{};
};

template <class Real>
PointRate<Real> rate_at(const Interval<Real>& interval, std::size_t point) {
  using std::sqrt;
  if (point == 0) return {interval.b0, interval.u0};
  if (point + 1 == kLimitPoints) return {interval.b1, interval.u1};
  const double f = interval.segment.limit_points[point].fraction;
  const Real b = (1 - f) * interval.b0 + f * interval.b1;
  return {b, sqrt(b)};
}

/// Wheel loads at one of the limit points.
template <class Real>
WheelLoad<Real> load_at(const Interval<Real>& interval, std::size_t point, Side side) {
  const SegmentPoint& place = interval.segment.limit_points[point];
  const PointRate<Real> rate = rate_at(interval, point);
  if (place.affine) {
    const AffineWheel& wheel = place.wheel[side];
    return {wheel.current_A(interval.a, rate.b, rate.u), wheel.voltage_V(interval.a, rate.b, rate.u),
            wheel.force_N(interval.a, rate.b, rate.u)};
  }
  return wheel_loads(interval.segment, place, interval.a, rate.b, rate.u)[side];
}

/// The interval with derivatives by b0 and b1; a rest end is a constant.
inline Interval<Jet> jet_interval(const Segment& segment, double b0, double b1) {
  const Jet x0 = b0 > 0 ? Jet::variable0(b0) : Jet(0.0), x1 = b1 > 0 ? Jet::variable1(b1) : Jet(0.0);
  const Jet u0 = sqrt(x0), u1 = sqrt(x1);
  return {segment, x0, x1, u0, u1, (x1 - x0) / (2 * segment.ds), 2 * segment.ds / (u0 + u1)};
}

/// The interval in plain numbers.
inline Interval<double> plain_interval(const Segment& segment, double b0, double b1) {
  const double u0 = std::sqrt(std::max(0.0, b0)), u1 = std::sqrt(std::max(0.0, b1));
  return {segment, b0, b1, u0, u1, (b1 - b0) / (2 * segment.ds), 2 * segment.ds / (u0 + u1)};
}

}  // namespace joulepath::nlp
