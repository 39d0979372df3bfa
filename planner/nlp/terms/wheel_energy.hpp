#pragma once

#include "planner/nlp/terms/term.hpp"

namespace joulepath::nlp {

/// Electrical energy (J) of a channel over a segment: the integral of V i by two Gauss-Legendre points in
/// time, exact on a straight line. Channels: left and right wheel with sharing: wheel, their sum (channel 0)
/// with sharing: bus.
///
/// What the battery gives is max(E, eta E) = E + (1 - eta) max(0, -E): the objective carries a variable
/// z >= 0 per channel with the row E + z >= 0, which is exact.
struct WheelEnergy {
  static constexpr std::string_view name = "recovered_energy";
  static constexpr std::size_t rows = 2;

  Bounds bounds(const Segment&, std::size_t) const { return {0.0, kNoLimit}; }
  template <class Real>
  Real operator()(const Interval<Real>& interval, std::size_t channel) const {
    const std::array<Real, 2> energy_J = both(interval);
    return energy_J[channel];
  }

  template <class Real>
  static std::array<Real, 2> both(const Interval<Real>& interval) {
    std::array<Real, 2> sum_W{Real(0.0), Real(0.0)};
    for (std::size_t q = 0; q < kEnergyPoints; ++q) {
      const SegmentPoint& point = interval.segment.energy_points[q];
      const Real u = (1 - kEnergyTimes[q]) * interval.u0 + kEnergyTimes[q] * interval.u1;
      const Sided<WheelLoad<Real>> load = wheel_loads(interval.segment, point, interval.a, Real(u * u), u);
      sum_W[0] += load.left.voltage_V * load.left.current_A;
      sum_W[1] += load.right.voltage_V * load.right.current_A;
    }
    const bool bus = interval.segment.plant->robot.power.sharing == PowerSharing::bus;
    const Real half = 0.5 * interval.dt;
    if (bus) return {half * (sum_W[0] + sum_W[1]), Real(0.0)};
    return {half * sum_W[0], half * sum_W[1]};
  }
};

}  // namespace joulepath::nlp
