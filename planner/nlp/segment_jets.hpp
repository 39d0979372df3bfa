#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/nlp/formulation.hpp"

namespace joulepath::nlp {

/// Roots of the squares at the two ends with their derivatives; zeros at a rest end, which is fixed.
struct EndRates {
  double u[2];
  double d[2];   ///< du/db
  double dd[2];  ///< d2u/db2

  EndRates(double b0, double b1) {
    const double b[2] = {b0, b1};
    for (int i = 0; i < 2; ++i) {
      u[i] = std::sqrt(std::max(0.0, b[i]));
      d[i] = u[i] > 0 ? 0.5 / u[i] : 0.0;
      dd[i] = u[i] > 0 ? -0.5 * d[i] / b[i] : 0.0;
    }
  }
};

/// Time of a segment by the squares at its ends, written out: 2 ds/(u0 + u1).
inline Jet duration_jet(double ds, const EndRates& r) {
  const double sum = r.u[0] + r.u[1], dt = 2 * ds / sum, p = -dt / sum, q = -2 * p / sum;
  return {dt,
          {p * r.d[0], p * r.d[1]},
          {q * r.d[0] * r.d[0] + p * r.dd[0], q * r.d[0] * r.d[1], q * r.d[1] * r.d[1] + p * r.dd[1]}};
}

/// What the power of a wheel needs of its AffineWheel.
struct AffinePower {
  Affine voltage_V{};
  Affine current_A{};
};

/// Electrical power V i where both are affine, at a time share tau of the segment: written out, since
/// a = (b1 - b0)/(2 ds) is linear in the squares and u is a sum of functions of one square each.
inline Jet power_jet(const AffinePower& power, double ds, double a, double tau, const EndRates& r, bool rest0,
                     bool rest1) {
  const Affine &V = power.voltage_V, &I = power.current_A;
  const double u = (1 - tau) * r.u[0] + tau * r.u[1];
  const double v = V.constant + V.of_a * a + (V.of_b * u + V.of_u) * u;
  const double i = I.constant + I.of_a * a + (I.of_b * u + I.of_u) * u;
  const double vu = 2 * V.of_b * u + V.of_u, iu = 2 * I.of_b * u + I.of_u;
  const double Pa = V.of_a * i + v * I.of_a, Pu = vu * i + v * iu;
  const double Paa = 2 * V.of_a * I.of_a, Pau = V.of_a * iu + vu * I.of_a;
  const double Puu = 2 * (V.of_b * i + vu * iu + v * I.of_b);
  const double h = 0.5 / ds, a0 = rest0 ? 0.0 : -h, a1 = rest1 ? 0.0 : h;
  const double u0 = (1 - tau) * r.d[0], u1 = tau * r.d[1];
  return {v * i,
          {Pa * a0 + Pu * u0, Pa * a1 + Pu * u1},
          {Paa * a0 * a0 + 2 * Pau * a0 * u0 + Puu * u0 * u0 + Pu * (1 - tau) * r.dd[0],
           Paa * a0 * a1 + Pau * (a0 * u1 + a1 * u0) + Puu * u0 * u1,
           Paa * a1 * a1 + 2 * Pau * a1 * u1 + Puu * u1 * u1 + Pu * tau * r.dd[1]}};
}

/// Energies of the channels and the time of a segment with derivatives by the squares at its ends: the
/// same numbers as Energy and Time through jets, written out where the model is affine.
struct SegmentJets {
  std::array<Jet, 2> energy_J{};
  Jet duration_s{};
};

inline bool is_affine(const Segment& segment) {
  return std::all_of(segment.energy_points.begin(), segment.energy_points.end(),
                     [](const SegmentPoint& point) { return point.affine; });
}

inline SegmentJets affine_segment_jets(double ds, const std::array<Sided<AffinePower>, kEnergyPoints>& power,
                                       bool bus, double b0, double b1) {
  SegmentJets jets;
  const EndRates rates(b0, b1);
  jets.duration_s = duration_jet(ds, rates);
  const double a = (b1 - b0) / (2 * ds);
  Jet sum_W[2];
  for (std::size_t q = 0; q < kEnergyPoints; ++q) {
    sum_W[0] += power_jet(power[q].left, ds, a, kEnergyTimes[q], rates, b0 <= 0, b1 <= 0);
    sum_W[1] += power_jet(power[q].right, ds, a, kEnergyTimes[q], rates, b0 <= 0, b1 <= 0);
  }
  const Jet half = 0.5 * jets.duration_s;
  if (bus)
    jets.energy_J = {half * (sum_W[0] + sum_W[1]), Jet(0.0)};
  else
    jets.energy_J = {half * sum_W[0], half * sum_W[1]};
  return jets;
}

/// Wheels' powers at the energy points of an affine segment.
inline std::array<Sided<AffinePower>, kEnergyPoints> affine_power(const Segment& segment) {
  std::array<Sided<AffinePower>, kEnergyPoints> power;
  for (std::size_t q = 0; q < kEnergyPoints; ++q)
    power[q] = map_sides(segment.energy_points[q].wheel, [](Side, const AffineWheel& wheel) {
      return AffinePower{wheel.voltage_V, wheel.current_A};
    });
  return power;
}

inline SegmentJets segment_jets(const Segment& segment, double b0, double b1) {
  const bool bus = segment.plant->robot.power.sharing == PowerSharing::bus;
  if (is_affine(segment)) return affine_segment_jets(segment.ds, affine_power(segment), bus, b0, b1);
  return {Energy::both(jet_interval(segment, b0, b1)), duration_jet(segment.ds, EndRates(b0, b1))};
}

}  // namespace joulepath::nlp
