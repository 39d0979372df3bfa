#pragma once

#include "model/kinematics.hpp"
#include "model/operating_point.hpp"
#include "model/power.hpp"

namespace joulepath {

/// How much a wheel's quantities change about an instant within a normal kernel: the slope times the kernel's
/// standard deviation.
struct WheelChange {
  double voltage_V{}, current_A{}, power_W{};

  /// What the mean of V i has beyond the product of the means: sigma^2 V' i' [Stein's lemma].
  [[nodiscard]] double product_W() const { return voltage_V * current_A; }
};

/// The changes of both wheels while the body's accelerations change by `jerk` (m/s^3, rad/s^3). A kernel of
/// another form counts by its standard deviation.
[[nodiscard]] Sided<WheelChange> change_within(const Plant& plant, const BodyMotion<double>& motion,
                                               const Twist<double>& jerk, const Site& site, double sigma_s);

/// Mean of max(0, P) over a normal kernel in which P changes by `change_W` (1 sigma):
///   P Phi(P/c) + c phi(P/c)
[[nodiscard]] double mean_positive_W(double mean_W, double change_W);

/// Means over a kernel of what motors draw from the supply and return to it: of each motor alone or of their
/// sum, as the supply counts them. The power of a mean is neither where the sign changes.
struct SupplyShares {
  double draw_W{};    ///< of the positive part
  double return_W{};  ///< of the negative part, negative
  double mixed_W{};   ///< the lesser of both, summed: what an unknown sign puts in doubt
};
[[nodiscard]] SupplyShares supply_shares(PowerSharing sharing, const Sided<double>& mean_W,
                                         const Sided<double>& change_W);

/// Mean of supply_power_W() over a kernel.
[[nodiscard]] inline double mean_supply_power_W(const PowerSupply& supply, const Sided<double>& mean_W,
                                                const Sided<double>& change_W) {
  const SupplyShares shares = supply_shares(supply.sharing, mean_W, change_W);
  return shares.draw_W + supply.regeneration_efficiency * shares.return_W;
}

}  // namespace joulepath
