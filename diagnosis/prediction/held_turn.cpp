#include "diagnosis/prediction/held_turn.hpp"

#include <cmath>
#include <numbers>

#include "diagnosis/prediction/added_torque.hpp"
#include "diagnosis/signals/site.hpp"
#include "diagnosis/thresholds.hpp"

// Design: docs/decisions/0501-motion.md
namespace joulepath {
namespace {

constexpr double kRelease_s = 0.3;  ///< of rest, after which a controller holds nothing

/// Share of the kernel in which friction has come to its bound in a new direction: before a turn begins.
double begun(const BodyMotion<double>& motion, double kernel_sigma_s) {
  if (motion.yaw_rate_rad_s * motion.yaw_acceleration_rad_s2 <= 0) return 0;
  const double change_rad_s = std::abs(motion.yaw_acceleration_rad_s2) * kernel_sigma_s;
  return std::erf(change_rad_s / (std::numbers::sqrt2 * kStillYawRate_rad_s));
}

}  // namespace

double HeldTurn::share(const RunSignals& signals, const BodyMotion<double>& motion, const Site& site) {
  const double sure = std::abs(site.turn_direction);
  if (sure > kSureTurn) direction_ = std::copysign(1.0, site.turn_direction);
  rested_s_ = stands(plant_.robot.geometry, motion) ? rested_s_ + signals.period_s : 0;
  if (rested_s_ > kRelease_s) direction_ = 0;
  return (1 - sure) * (1 - begun(motion, signals.kernel_sigma_s)) * direction_;
}

void HeldTurn::load(const RunSignals& signals, const BodyMotion<double>& motion, const Site& site,
                    Sided<WheelState<double>>& state) {
  if (moment_Nm_.left == 0 && moment_Nm_.right == 0) return;
  const Geometry& geometry = plant_.robot.geometry;
  const double part = share(signals, motion, site),
               force_N = part * moment_Nm_[part > 0 ? Side::left : Side::right] / (2 * geometry.half_track_m);
  for (Side side : kSides)
    add_torque(plant_, site, side, side_sign(side) * geometry.wheel_radius_m[side] * force_N, state[side]);
}

}  // namespace joulepath
