#pragma once

#include <cmath>

#include "model/motion.hpp"

namespace joulepath {

/// Wheel speeds (rad/s) of a body twist; the same formula maps accelerations.
///
///   r q' = v +/- l omega, + for the right wheel               [P1, Eqs. (2), (3)]
///
/// The paper's Eq. (35) prints (2 v +/- l omega)/(2 r), which fits only if l were the whole track.
template <class Real>
Sided<Real> wheel_speeds_rad_s(const Geometry& geometry, const Real& speed_m_s, const Real& yaw_rate_rad_s) {
  const Real across_m_s = geometry.half_track_m * yaw_rate_rad_s;
  return {(speed_m_s - across_m_s) / geometry.wheel_radius_m.left,
          (speed_m_s + across_m_s) / geometry.wheel_radius_m.right};
}

template <class Real>
struct Twist {
  Real speed_m_s{};
  Real yaw_rate_rad_s{};
};

/// Body twist of wheel speeds; inverse of wheel_speeds_rad_s().      [P1, Eqs. (5), (6)]
template <class Real>
Twist<Real> body_twist(const Geometry& geometry, const Sided<Real>& wheel_speed_rad_s) {
  const Real left_m_s = geometry.wheel_radius_m.left * wheel_speed_rad_s.left;
  const Real right_m_s = geometry.wheel_radius_m.right * wheel_speed_rad_s.right;
  return {(right_m_s + left_m_s) / 2.0, (right_m_s - left_m_s) / (2.0 * geometry.half_track_m)};
}

constexpr double sign_of(double value) { return (value > 0) - (value < 0); }

/// Speed of the casters, in a spin that of the wheels: sqrt(v^2 + (l omega)^2). Its integral is the distance
/// over which they align.
inline double caster_speed_m_s(const Geometry& geometry, double speed_m_s, double yaw_rate_rad_s) {
  return std::hypot(speed_m_s, geometry.half_track_m * yaw_rate_rad_s);
}

/// Caster course that a motion demands: 0 on a straight line, +/-1 in a spin,
///   course = l omega / sqrt(v^2 + (l omega)^2).
inline double course_of(const Geometry& geometry, double speed_m_s, double yaw_rate_rad_s) {
  const double size = caster_speed_m_s(geometry, speed_m_s, yaw_rate_rad_s);
  return size > 0 ? geometry.half_track_m * yaw_rate_rad_s / size : 0.0;
}

/// The site of a motion with given speeds, its directions being their signs. On a path use the
/// path's tangent motion (v = +/-1 m/s, omega = curvature), so that directions hold at rest too.
inline Site site_of(const Geometry& geometry, const Pose& pose, double payload_kg, double speed_m_s,
                    double yaw_rate_rad_s, double time_of_day_s = 0.0) {
  const Sided<double> wheels = wheel_speeds_rad_s(geometry, speed_m_s, yaw_rate_rad_s);
  return {.pose = pose,
          .time_of_day_s = time_of_day_s,
          .payload_kg = payload_kg,
          .travel_direction = sign_of(speed_m_s),
          .turn_direction = sign_of(yaw_rate_rad_s),
          .wheel_direction = {sign_of(wheels.left), sign_of(wheels.right)},
          .course = course_of(geometry, speed_m_s, yaw_rate_rad_s),
          .memory = {}};
}

}  // namespace joulepath
