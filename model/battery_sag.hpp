#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "model/robot.hpp"

namespace joulepath {

/// What the internal resistance takes of a battery's open-circuit voltage U at a power P at the terminals:
///   sag = R i = U/2 - sqrt(U^2/4 - R P),   the smaller current of P = (U - R i) i.
/// It rises with P, negative where P charges. Beyond the greatest power, U^2/(4 R), it goes on along its
/// tangent just before that, so that a solver may pass there.
class BatterySag {
 public:
  explicit BatterySag(const Battery& battery)
      : half_V_(0.5 * battery.open_circuit_voltage_V), resistance_ohm_(battery.internal_resistance_ohm) {}

  [[nodiscard]] bool none() const { return resistance_ohm_ == 0.0 || !std::isfinite(half_V_); }

  double operator()(double power_W) const { return none() ? 0.0 : law(power_W).value; }

  /// The same with derivatives by forward differentiation.
  template <class Jet>
  auto operator()(const Jet& power_W) const -> decltype(power_W.through(0.0, 0.0, 0.0)) {
    if (none()) return Jet(0.0);
    const Law at = law(power_W.value);
    return power_W.through(at.value, at.slope, at.bend);
  }

  /// The same over an interval.
  template <class Range>
  auto operator()(const Range& power_W) const -> decltype(Range(power_W.low, power_W.high)) {
    return none() ? Range(0.0) : Range(law(power_W.low).value, law(power_W.high).value);
  }

 private:
  struct Law {
    double value{}, slope{}, bend{};
  };
  Law law(double power_W) const {
    constexpr double kLeastRoot = 1e-3;  ///< of U/2: the tangent takes over there
    const double least = kLeastRoot * half_V_, square = half_V_ * half_V_ - resistance_ohm_ * power_W;
    const double root = std::sqrt(std::max(square, least * least));
    const double slope = 0.5 * resistance_ohm_ / root;
    if (square < least * least) {
      const double tangent_W = (half_V_ * half_V_ - root * root) / resistance_ohm_;
      return {half_V_ - root + slope * (power_W - tangent_W), slope, 0};
    }
    const double value = std::isfinite(root) ? resistance_ohm_ * power_W / (half_V_ + root) : -kNoLimit;
    return {value, slope, 0.5 * resistance_ohm_ * slope / square};
  }

  double half_V_{};
  double resistance_ohm_{};
};

}  // namespace joulepath
