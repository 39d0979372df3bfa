#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <type_traits>

#include "model/operating_point.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/nlp/interval/jet.hpp"
#include "planner/nlp/interval/range.hpp"

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

/// A wheel's current, voltage and contact force if they are affine: with every effect except those with a
/// nonlinear law (gear loss, driver drop, Stribeck friction).
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
  Real power_W{};
};

/// A place within a segment with the model's inputs there.
struct SegmentPoint {
  double fraction{};    ///< of the segment's length
  double time_share{};  ///< of the segment's time
  PathRates rates{};
  Site site{};
  bool affine{};
  Sided<AffineWheel> wheel{};
};

/// Share of a segment's length inside of it at which its ends are evaluated: the law may change at the node
/// itself.
inline constexpr double kInset = 1e-7;
inline constexpr std::size_t kLimitPoints = 3;   ///< both ends, evaluated inside the segment, and the middle
inline constexpr std::size_t kEnergyPoints = 2;  ///< Gauss-Legendre in time
inline constexpr std::array<double, kEnergyPoints> kEnergyTimes{0.21132486540518712, 0.78867513459481288};

inline constexpr KinkRounding kLeastRounding{};

/// The part of the path between two neighboring nodes.
struct Segment {
  double s0{};
  double ds{};
  const Plant* plant{};
  const KinkRounding* rounding{&kLeastRounding};
  std::array<SegmentPoint, kLimitPoints> limit_points{};
  std::array<SegmentPoint, kEnergyPoints> energy_points{};
};

/// Motion of the path coordinate at an instant.
template <class Real>
struct Motion {
  Real a{};  ///< acceleration
  Real b{};  ///< square of the rate
  Real u{};  ///< rate
};

/// Loads of both wheels at an interval's limit points, evaluated once: many limits ask for them.
template <class Real>
using PointLoads = std::array<std::optional<Sided<WheelLoad<Real>>>, kLimitPoints>;

/// Two neighboring nodes as the input of a term, with constant acceleration between them. Every kind of
/// interval has `Real`, `segment`, `dt`, at_limit_point() and at_energy_point(); see jerk_interval.hpp.
template <class R>
struct Interval {
  using Real = R;
  const Segment& segment;
  Real b0{}, b1{};  ///< rate^2
  Real u0{}, u1{};  ///< rate
  Real a{};         ///< (b1 - b0)/(2 ds), constant in the segment
  Real dt{};        ///< 2 ds/(u0 + u1), exact
  mutable PointLoads<Real> loads{};

  Motion<Real> at_limit_point(std::size_t point) const {
    using std::sqrt;
    if (point == 0) return {a, b0, u0};
    if (point + 1 == kLimitPoints) return {a, b1, u1};
    const double f = segment.limit_points[point].fraction;
    const Real b = (1 - f) * b0 + f * b1;
    return {a, b, sqrt(b)};
  }
  Motion<Real> at_energy_point(std::size_t point) const {
    const double tau = kEnergyTimes[point];
    const Real u = (1 - tau) * u0 + tau * u1;
    return {a, Real(u * u), u};
  }
};

/// Inlined, so that a term computes nothing but the part of the load that it uses.
template <class Real>
[[gnu::always_inline]] inline WheelLoad<Real> affine_load(const AffineWheel& wheel,
                                                          const Motion<Real>& motion) {
  const Real current_A = wheel.current_A(motion.a, motion.b, motion.u);
  const Real voltage_V = wheel.voltage_V(motion.a, motion.b, motion.u);
  return {current_A, voltage_V, wheel.force_N(motion.a, motion.b, motion.u), voltage_V * current_A};
}

/// Wheel loads at a point for a motion there.
template <class Real>
Sided<WheelLoad<Real>> wheel_loads(const Segment& segment, const SegmentPoint& point,
                                   const Motion<Real>& motion) {
  if (point.affine) return {affine_load(point.wheel.left, motion), affine_load(point.wheel.right, motion)};
  if constexpr (std::is_same_v<Real, Range>) {
    constexpr Range anything{-kNoLimit, kNoLimit};
    constexpr WheelLoad<Range> any{anything, anything, anything, anything};
    return {any, any};
  } else {
    const Sided<WheelState<Real>> wheels =
        operating_point(*segment.plant, PathMotion::body_motion(point.rates, motion.u, motion.a), point.site,
                        *segment.rounding);
    return map_sides(wheels, [](Side, const WheelState<Real>& wheel) {
      return WheelLoad<Real>{wheel.current_A, wheel.voltage_V, wheel.contact_force_N, wheel.power_W};
    });
  }
}

/// Where a law is not affine it is evaluated with derivatives by acceleration and rate alone: a law of a
/// motor has no other arguments, and five derivatives cost four times as much.
template <std::size_t N>
requires(N > 2) Sided<WheelLoad<JetOf<N>>> wheel_loads(const Segment& segment, const SegmentPoint& point,
                                                       const Motion<JetOf<N>>& motion) {
  if (point.affine) return {affine_load(point.wheel.left, motion), affine_load(point.wheel.right, motion)};
  const Jet a = Jet::variable(0, motion.a.value), u = Jet::variable(1, motion.u.value);
  return map_sides(wheel_loads(segment, point, Motion<Jet>{a, u * u, u}),
                   [&](Side, const WheelLoad<Jet>& load) {
                     const auto by_motion = [&](const Jet& law) { return composed(law, motion.a, motion.u); };
                     return WheelLoad<JetOf<N>>{by_motion(load.current_A), by_motion(load.voltage_V),
                                                by_motion(load.force_N), by_motion(load.power_W)};
                   });
}

/// Wheel load at one of the limit points.
template <class AnyInterval, class Real = typename AnyInterval::Real>
[[gnu::always_inline]] inline WheelLoad<Real> load_at(const AnyInterval& interval, std::size_t point,
                                                      Side side) {
  const SegmentPoint& place = interval.segment.limit_points[point];
  const Motion<Real> motion = interval.at_limit_point(point);
  if (place.affine) return affine_load(place.wheel[side], motion);
  auto& loads = interval.loads[point];
  if (!loads) loads = wheel_loads(interval.segment, place, motion);
  return (*loads)[side];
}

/// The interval with derivatives by b0 and b1; a rest end is a constant.
inline Interval<Jet> jet_interval(const Segment& segment, double b0, double b1) {
  const Jet x0 = b0 > 0 ? Jet::variable(0, b0) : Jet(0.0), x1 = b1 > 0 ? Jet::variable(1, b1) : Jet(0.0);
  const Jet u0 = sqrt(x0), u1 = sqrt(x1);
  return {segment, x0, x1, u0, u1, (x1 - x0) / (2 * segment.ds), 2 * segment.ds / (u0 + u1)};
}

/// The interval in plain numbers.
inline Interval<double> plain_interval(const Segment& segment, double b0, double b1) {
  const double u0 = std::sqrt(std::max(0.0, b0)), u1 = std::sqrt(std::max(0.0, b1));
  return {segment, b0, b1, u0, u1, (b1 - b0) / (2 * segment.ds), 2 * segment.ds / (u0 + u1)};
}

}  // namespace joulepath::nlp
