#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/nlp/transcription/formulation.hpp"

namespace joulepath::nlp {

/// Root of the square of the rate at a node with its derivatives; zeros at a rest end, which is fixed.
struct NodeRate {
  double b{};
  double u{};
  double d{};   ///< du/db
  double dd{};  ///< d2u/db2

  explicit NodeRate(double square) : b(square), u(std::sqrt(std::max(0.0, square))) {
    if (!(u > 0)) return;
    d = 0.5 / u;
    dd = -0.5 * d / b;
  }
};

/// Time of a segment as an explicit function of the squares at its ends: 2 ds/(u0 + u1).
inline Jet duration_jet(double ds, const NodeRate& r0, const NodeRate& r1) {
  const double sum = r0.u + r1.u, dt = 2 * ds / sum, p = -dt / sum, q = -2 * p / sum;
  return {
      dt, {p * r0.d, p * r1.d}, {q * r0.d * r0.d + p * r0.dd, q * r0.d * r1.d, q * r1.d * r1.d + p * r1.dd}};
}

/// The part of an AffineWheel that determines its power.
struct AffinePower {
  Affine voltage_V{};
  Affine current_A{};
};

/// Electrical power with its derivatives by acceleration and rate; the power of two wheels is their sum.
struct PowerLaw {
  double value{}, a{}, u{}, aa{}, au{}, uu{};

  friend PowerLaw operator+(const PowerLaw& x, const PowerLaw& y) {
    return {x.value + y.value, x.a + y.a, x.u + y.u, x.aa + y.aa, x.au + y.au, x.uu + y.uu};
  }
};

/// V i where both are affine.
inline PowerLaw power_law(const AffinePower& power, double a, double u) {
  const Affine &V = power.voltage_V, &I = power.current_A;
  const double v = V.constant + V.of_a * a + (V.of_b * u + V.of_u) * u;
  const double i = I.constant + I.of_a * a + (I.of_b * u + I.of_u) * u;
  const double vu = 2 * V.of_b * u + V.of_u, iu = 2 * I.of_b * u + I.of_u;
  return {v * i,
          V.of_a * i + v * I.of_a,
          vu * i + v * iu,
          2 * V.of_a * I.of_a,
          V.of_a * iu + vu * I.of_a,
          2 * (V.of_b * i + vu * iu + v * I.of_b)};
}

/// Power as an explicit function of the squares at the ends of its segment, at a time share tau: a = (b1 -
/// b0)/(2 ds) is linear in the squares and u is a sum of functions of one square each.
inline Jet power_jet(const PowerLaw& P, double ds, double tau, const NodeRate& r0, const NodeRate& r1) {
  const double h = 0.5 / ds, a0 = r0.b <= 0 ? 0.0 : -h, a1 = r1.b <= 0 ? 0.0 : h;
  const double u0 = (1 - tau) * r0.d, u1 = tau * r1.d;
  return {P.value,
          {P.a * a0 + P.u * u0, P.a * a1 + P.u * u1},
          {P.aa * a0 * a0 + 2 * P.au * a0 * u0 + P.uu * u0 * u0 + P.u * (1 - tau) * r0.dd,
           P.aa * a0 * a1 + P.au * (a0 * u1 + a1 * u0) + P.uu * u0 * u1,
           P.aa * a1 * a1 + 2 * P.au * a1 * u1 + P.uu * u1 * u1 + P.u * tau * r1.dd}};
}

/// Energies of the channels and the time of a segment with derivatives by the squares at its ends: the same
/// numbers as Energy and Time through jets, as explicit formulas for an affine model.
struct SegmentJets {
  std::array<Jet, 2> energy_J{};
  Jet duration_s{};
};

inline bool is_affine(const Segment& segment) {
  return std::all_of(segment.energy_points.begin(), segment.energy_points.end(),
                     [](const SegmentPoint& point) { return point.affine; });
}

inline SegmentJets affine_segment_jets(double ds, const std::array<Sided<AffinePower>, kEnergyPoints>& power,
                                       bool bus, const NodeRate& r0, const NodeRate& r1) {
  SegmentJets jets;
  jets.duration_s = duration_jet(ds, r0, r1);
  const Jet half = 0.5 * jets.duration_s;
  const double a = (r1.b - r0.b) / (2 * ds);
  Jet sum_W[2];
  for (std::size_t q = 0; q < kEnergyPoints; ++q) {
    const double tau = kEnergyTimes[q], u = (1 - tau) * r0.u + tau * r1.u;
    const PowerLaw left = power_law(power[q].left, a, u), right = power_law(power[q].right, a, u);
    sum_W[0] += power_jet(bus ? left + right : left, ds, tau, r0, r1);
    if (!bus) sum_W[1] += power_jet(right, ds, tau, r0, r1);
  }
  jets.energy_J[0] = half * sum_W[0];
  if (!bus) jets.energy_J[1] = half * sum_W[1];
  return jets;
}

/// x + c y.
inline Affine sum(const Affine& x, double c, const Affine& y) {
  return {x.constant + c * y.constant, x.of_a + c * y.of_a, x.of_b + c * y.of_b, x.of_u + c * y.of_u};
}

/// Wheels' powers at the energy points of an affine segment, with the price of their heat, V i + price i^2.
inline std::array<Sided<AffinePower>, kEnergyPoints> affine_power(const Segment& segment) {
  std::array<Sided<AffinePower>, kEnergyPoints> power;
  for (std::size_t q = 0; q < kEnergyPoints; ++q)
    power[q] = map_sides(segment.energy_points[q].wheel, [&](Side side, const AffineWheel& wheel) {
      return AffinePower{sum(wheel.voltage_V, segment.plant->heat_price_ohm[side], wheel.current_A),
                         wheel.current_A};
    });
  return power;
}

inline SegmentJets segment_jets(const Segment& segment, double b0, double b1) {
  const bool bus = segment.plant->robot.power.sharing == PowerSharing::bus;
  const NodeRate r0(b0), r1(b1);
  if (is_affine(segment)) return affine_segment_jets(segment.ds, affine_power(segment), bus, r0, r1);
  return {Energy::both(jet_interval(segment, b0, b1)), duration_jet(segment.ds, r0, r1)};
}

}  // namespace joulepath::nlp
