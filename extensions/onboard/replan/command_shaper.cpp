#include "extensions/onboard/replan/command_shaper.hpp"

#include <algorithm>
#include <cmath>

#include "model/limit_table.hpp"

namespace joulepath {
namespace {

constexpr double kStill = 1e-9;  ///< m/s or rad/s
constexpr int kHalvings = 12;

double going_on(double value, double slope, double elapsed_s) {
  const double then = value + slope * elapsed_s;
  return std::abs(then) < kStill ? 0.0 : then;
}

/// The least acceleration from which a speed v can still end at 0 with acceleration 0: the mirrored bound of
/// accelerate() with 0 as the wanted speed, whose tightest time has T + h = sqrt(2 v/j).
double least_to_stand(double v, double jerk_m_s3, double period_s) {
  const double u = std::max(period_s, std::sqrt(2 * v / jerk_m_s3));
  return u > period_s ? -v / u - jerk_m_s3 * (u - period_s) / 2 : -v / period_s;
}

/// Limits of the drives, as opposed to those of the body's motion.
bool is_of_drives(const Limit& row) {
  return row.per_wheel || row.field == &Limits::battery_power_W || row.field == &Limits::charge_power_W;
}

}  // namespace

void CommandShaper::advance(double elapsed_s) {
  now_.rate = std::max(0.0, going_on(now_.rate, now_.acceleration_m_s2, elapsed_s));
  now_.yaw_rate_rad_s = going_on(now_.yaw_rate_rad_s, now_.yaw_acceleration_rad_s2, elapsed_s);
}

double CommandShaper::spacing_s(const Limits& limits, double period_s) {
  const double range = limits.acceleration_m_s2 + limits.deceleration_m_s2;
  if (!std::isfinite(limits.jerk_m_s3)) return 0;
  const double longest_s = std::isfinite(range) ? range / limits.jerk_m_s3 : 2.0;
  return std::max(period_s, longest_s / static_cast<double>(kLook - 1));
}

double CommandShaper::accelerate(const Limits& limits, std::span<const double> wanted, double period_s) {
  const double v = now_.rate, spacing = spacing_s(limits, period_s);
  double most = kNoLimit;
  for (std::size_t m = 0; m < wanted.size(); ++m) {
    const double h = spacing * static_cast<double>(m);
    const double ramp = m == 0 ? 0.0 : limits.jerk_m_s3 * h * (h + period_s) / 2;
    most = std::min(most, (std::min(wanted[m], limits.speed_m_s) - v + ramp) / (period_s + h));
  }
  const double step = limits.jerk_m_s3 * period_s;
  least_ = std::isfinite(step) ? now_.acceleration_m_s2 - step : -limits.deceleration_m_s2;
  most_ = std::isfinite(step) ? now_.acceleration_m_s2 + step : limits.acceleration_m_s2;
  const double a = std::clamp(std::max(most, least_to_stand(v, limits.jerk_m_s3, period_s)),
                              -limits.deceleration_m_s2, limits.acceleration_m_s2);
  now_.acceleration_m_s2 = std::max(-v / period_s, std::clamp(a, least_, most_));
  return end_rate(period_s);
}

double CommandShaper::fastest_on(double yaw_per_m, const Limits& limits, double period_s) const {
  const double bend = std::max(kStill, std::abs(yaw_per_m));
  const double turning = std::copysign(1.0, yaw_per_m) * now_.yaw_rate_rad_s;
  const double reached = turning + limits.yaw_acceleration_rad_s2 * period_s;
  return std::min({limits.yaw_rate_rad_s / bend, std::sqrt(limits.lateral_acceleration_m_s2 / bend),
                   std::max(0.0, reached) / bend});
}

void CommandShaper::turn(const Limits& limits, double wanted_rad_s, double period_s) {
  const double most = std::min(limits.yaw_rate_rad_s,
                               limits.lateral_acceleration_m_s2 / std::max(kStill, end_rate(period_s)));
  const double wanted = std::clamp(wanted_rad_s, -most, most);
  now_.yaw_acceleration_rad_s2 = std::clamp((wanted - now_.yaw_rate_rad_s) / period_s,
                                            -limits.yaw_acceleration_rad_s2, limits.yaw_acceleration_rad_s2);
}

bool CommandShaper::drives_keep(const Limits& limits, double payload_kg, double period_s) const {
  const BodyMotion<double> motion{travel_sign_ * end_rate(period_s), travel_sign_ * now_.acceleration_m_s2,
                                  now_.yaw_rate_rad_s + period_s * now_.yaw_acceleration_rad_s2,
                                  now_.yaw_acceleration_rad_s2};
  const Site site =
      site_of(plant_.robot.geometry, {}, payload_kg, motion.speed_m_s, motion.yaw_rate_rad_s, 0.0);
  const LimitState state = limit_state(plant_, motion, site, now_.acceleration_m_s2, 0.0);
  bool keeps = true;
  for_each_limit(state, limits, [&](const Limit& row, double value, double limit) {
    keeps = keeps && (!is_of_drives(row) || limit_fraction(value, limit) <= 1);
  });
  return keeps;
}

void CommandShaper::keep_drives(const Limits& limits, double payload_kg, double period_s) {
  if (drives_keep(limits, payload_kg, period_s)) return;
  const double a = now_.acceleration_m_s2, turning = now_.yaw_acceleration_rad_s2;
  const double gentle = least_ <= most_ ? std::clamp(0.0, least_, most_) : a;
  double low = 0, high = 1;
  const auto with_share = [&](double share) {
    now_.acceleration_m_s2 = gentle + share * (a - gentle);
    now_.yaw_acceleration_rad_s2 = share * turning;
    return drives_keep(limits, payload_kg, period_s);
  };
  if (!with_share(0)) {  // too fast for the drives: slowing down is all that helps
    (void)with_share(1);
    return;
  }
  for (int i = 0; i < kHalvings; ++i) (with_share(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
  (void)with_share(low);
}

}  // namespace joulepath
