#include "model/mean_power.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace joulepath {
namespace {

void add_share(double mean_W, double change_W, SupplyShares& shares) {
  const double draw_W = mean_positive_W(mean_W, change_W), return_W = mean_W - draw_W;
  shares.draw_W += draw_W;
  shares.return_W += return_W;
  shares.mixed_W += std::min(draw_W, -return_W);
}

}  // namespace

Sided<WheelChange> change_within(const Plant& plant, const BodyMotion<double>& motion,
                                 const Twist<double>& jerk, const Site& site, double sigma_s) {
  if (sigma_s <= 0) return {};
  const auto after = [&](double time_s) {
    return operating_point(plant,
                           BodyMotion<double>{motion.speed_m_s + time_s * motion.acceleration_m_s2,
                                              motion.acceleration_m_s2 + time_s * jerk.speed_m_s,
                                              motion.yaw_rate_rad_s + time_s * motion.yaw_acceleration_rad_s2,
                                              motion.yaw_acceleration_rad_s2 + time_s * jerk.yaw_rate_rad_s},
                           site);
  };
  const Sided<WheelState<double>> begin = after(-sigma_s), end = after(sigma_s);
  Sided<WheelChange> change;
  for (const Side side : kSides)
    change[side] = {0.5 * (end[side].voltage_V - begin[side].voltage_V),
                    0.5 * (end[side].current_A - begin[side].current_A),
                    0.5 * (end[side].power_W - begin[side].power_W)};
  return change;
}

double mean_positive_W(double mean_W, double change_W) {
  const double size_W = std::abs(change_W);
  if (size_W <= 1e-12 * std::abs(mean_W) || size_W == 0) return std::max(0.0, mean_W);
  const double z = mean_W / size_W;
  return 0.5 * mean_W * std::erfc(-z / std::numbers::sqrt2) +
         size_W * std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
}

SupplyShares supply_shares(PowerSharing sharing, const Sided<double>& mean_W, const Sided<double>& change_W) {
  SupplyShares shares;
  if (sharing == PowerSharing::bus) {
    add_share(mean_W.left + mean_W.right, change_W.left + change_W.right, shares);
    return shares;
  }
  for (const Side side : kSides) add_share(mean_W[side], change_W[side], shares);
  return shares;
}

}  // namespace joulepath
