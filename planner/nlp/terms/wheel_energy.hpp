#pragma once

#include "planner/nlp/terms/term.hpp"

namespace joulepath::nlp {

/// Electrical energy (J) of a channel over a segment: the integral of V i by two Gauss-Legendre points in
/// time, exact on a straight line. Channels: left and right wheel with sharing: wheel, their sum (channel 0)
/// with sharing: bus.
///
/// The energy from the battery is max(E, eta E) = E + (1 - eta) max(0, -E): the objective contains a variable
/// z >= 0 per channel with the row E + z >= 0, which is exact. Where a planner pays for heat, E holds that
/// price, too.
struct WheelEnergy {
  static constexpr std::string_view name = "recovered_energy";
  static constexpr std::size_t rows = 2;

  Bounds bounds(const Segment&, std::size_t) const { return {0.0, kNoLimit}; }
  template <class AnyInterval>
  auto operator()(const AnyInterval& interval, std::size_t channel) const {
    return both(interval)[channel];
  }

  /// Energy of both channels.
  template <class AnyInterval, class Real = typename AnyInterval::Real>
  static std::array<Real, 2> both(const AnyInterval& interval) {
    const std::array<std::array<Real, 2>, kEnergyPoints> parts = by_point(interval);
    return {parts[0][0] + parts[1][0], parts[0][1] + parts[1][1]};
  }

  /// Contribution of each quadrature point to both channels: [point][channel].
  template <class AnyInterval, class Real = typename AnyInterval::Real>
  static std::array<std::array<Real, 2>, kEnergyPoints> by_point(const AnyInterval& interval) {
    const bool bus = interval.segment.plant->robot.power.sharing == PowerSharing::bus;
    const Real half = 0.5 * interval.dt;
    std::array<std::array<Real, 2>, kEnergyPoints> parts;
    for (std::size_t q = 0; q < kEnergyPoints; ++q) {
      const Sided<WheelLoad<Real>> load =
          wheel_loads(interval.segment, interval.segment.energy_points[q], interval.at_energy_point(q));
      const Real left_W = cost_W(interval, load.left, Side::left),
                 right_W = cost_W(interval, load.right, Side::right);
      if (bus)
        parts[q] = {half * (left_W + right_W), Real(0.0)};
      else
        parts[q] = {half * left_W, half * right_W};
    }
    return parts;
  }

 private:
  template <class AnyInterval, class Real = typename AnyInterval::Real>
  static Real cost_W(const AnyInterval& interval, const WheelLoad<Real>& load, Side side) {
    const double price_ohm = interval.segment.plant->heat_price_ohm[side];
    return price_ohm == 0 ? load.power_W : Real(load.power_W + price_ohm * (load.current_A * load.current_A));
  }
};

/// Energy from the battery for a segment (J), without standby: max(E, eta E) summed over the channels. Under
/// a jerk limit the maximum is taken at each quadrature point: there the power may change its sign within a
/// segment.
template <class AnyInterval>
double kept_energy_J(const AnyInterval& interval) {
  const double eta = interval.segment.plant->robot.power.regeneration_efficiency;
  double sum_J = 0;
  const auto add = [&](const std::array<double, 2>& energy_J) {
    for (double part_J : energy_J) sum_J += std::max(part_J, eta * part_J);
  };
  if constexpr (std::is_same_v<AnyInterval, JerkInterval<double>>) {
    for (const std::array<double, 2>& part_J : WheelEnergy::by_point(interval)) add(part_J);
  } else {
    add(WheelEnergy::both(interval));
  }
  return sum_J;
}

}  // namespace joulepath::nlp
