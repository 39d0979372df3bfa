#include "diagnosis/prediction/region_edge.hpp"

#include <array>
#include <cmath>
#include <variant>

namespace joulepath {
namespace {

/// Midpoints of five equally likely parts of a normal kernel, in standard deviations.
constexpr std::array<double, 5> kParts{-1.2816, -0.5244, 0.0, 0.5244, 1.2816};

Site moved_along(Site site, double distance_m) {
  site.pose.x_m += distance_m * std::cos(site.pose.heading_rad);
  site.pose.y_m += distance_m * std::sin(site.pose.heading_rad);
  return site;
}

bool edge_within(const Plant& plant, const Site& site, double reach_m) {
  for (const Effect& effect : plant.effects) {
    const bool crossed = std::visit(
        [&](const auto& e) {
          if constexpr (requires { e.contains(0.0, 0.0); }) {
            const Pose first = moved_along(site, kParts.front() * reach_m).pose,
                       last = moved_along(site, kParts.back() * reach_m).pose;
            return e.contains(first.x_m, first.y_m) != e.contains(last.x_m, last.y_m);
          }
          return false;
        },
        effect);
    if (crossed) return true;
  }
  return false;
}

}  // namespace

Sided<WheelState<double>> operating_point_over_kernel(const Plant& plant, const BodyMotion<double>& motion,
                                                      const Site& site, double reach_m) {
  if (!edge_within(plant, site, reach_m)) return operating_point(plant, motion, site);
  Sided<WheelState<double>> mean{};
  for (double part : kParts) {
    const auto wheels = operating_point(plant, motion, moved_along(site, part * reach_m));
    for (Side side : kSides) {
      const double weight = 1.0 / kParts.size();
      mean[side].speed_rad_s += weight * wheels[side].speed_rad_s;
      mean[side].contact_force_N += weight * wheels[side].contact_force_N;
      mean[side].torque_Nm += weight * wheels[side].torque_Nm;
      mean[side].current_A += weight * wheels[side].current_A;
      mean[side].voltage_V += weight * wheels[side].voltage_V;
      mean[side].power_W += weight * wheels[side].power_W;
    }
  }
  return mean;
}

}  // namespace joulepath
