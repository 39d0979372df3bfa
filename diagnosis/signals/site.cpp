#include "diagnosis/signals/site.hpp"

#include <cmath>
#include <numbers>

#include "diagnosis/signals/friction_direction.hpp"
#include "diagnosis/thresholds.hpp"

namespace joulepath {
namespace {

/// Mean sign of the yaw rate over the kernel: of a rate that changes evenly, with a noise of
/// kStillYawRate_rad_s.
double turn_direction(const BodyMotion<double>& motion, double kernel_sigma_s) {
  const double width_rad_s = std::hypot(kStillYawRate_rad_s, motion.yaw_acceleration_rad_s2 * kernel_sigma_s);
  return std::erf(motion.yaw_rate_rad_s / (std::numbers::sqrt2 * width_rad_s));
}

}  // namespace

Site site_at(const RunSignals& signals, Eigen::Index j, const Geometry& geometry,
             const BodyMotion<double>& motion, const EffectMemory& memory) {
  const double across_m_s = geometry.half_track_m * motion.yaw_rate_rad_s;
  const double size_m_s = std::sqrt(motion.speed_m_s * motion.speed_m_s + across_m_s * across_m_s +
                                    kStillSpeed_m_s * kStillSpeed_m_s);
  const bool placed = signals.x_m.size() > 0;
  return {.pose = {placed ? signals.x_m[j] : 0.0, placed ? signals.y_m[j] : 0.0, signals.heading_rad[j]},
          .time_of_day_s = signals.time_of_day_s[j],
          .payload_kg = signals.payload_kg[j],
          .travel_direction = soft_sign(motion.speed_m_s, kStillSpeed_m_s),
          .turn_direction = turn_direction(motion, signals.kernel_sigma_s),
          .wheel_direction = {signals.direction(Side::left, j), signals.direction(Side::right, j)},
          .course = across_m_s / size_m_s,
          .memory = memory};
}

bool stands(const Geometry& geometry, const BodyMotion<double>& motion) {
  return std::abs(motion.speed_m_s) < kStandstillAlong_m_s &&
         std::abs(motion.yaw_rate_rad_s) * geometry.half_track_m < kStandstillAcross_m_s;
}

Sided<WheelChange> change_at(const Plant& plant, const RunSignals& signals, Eigen::Index j,
                             const BodyMotion<double>& motion, const Site& site) {
  Twist<double> jerk{};
  const Sided<Eigen::VectorXd>& wheels = signals.wheel_jerk_rad_s3;
  if (wheels.left.size() == signals.size())
    jerk = body_twist(plant.robot.geometry, Sided<double>{wheels.left[j], wheels.right[j]});
  return change_within(plant, motion, jerk, site, signals.kernel_sigma_s);
}

}  // namespace joulepath
