#include <algorithm>
#include <cmath>
#include <numbers>

#include "bodies.hpp"

namespace blind {
namespace {

constexpr double kScrubPresliding_rad = 0.004;

}  // namespace

/// Friction that opposes the wheel's own motion, before its sign: all loads of the bearing.
double Plant::resisting_level(std::size_t k, double day_s) const {
  const Wheel& wheel = wheel_[k];
  const double speed = std::abs(wheel.speed_rad_s);
  const double reference = nominal_.top_speed_m_s / nominal_.wheel_radius_m[k];
  const double shape =
      1 + w_.form * (speed / reference - 0.5) + w_.rolling_speed_slope_s_m * speed * m_.wheel_radius_m[k];
  double level = 0;
  level += w_.rolling_coefficient * normal_N_ * m_.wheel_radius_m[k] * shape;
  const bool on_patch =
      x_m_ > w_.patch_m[0] && x_m_ < w_.patch_m[1] && y_m_ > w_.patch_m[2] && y_m_ < w_.patch_m[3];
  if (on_patch) level += w_.patch_coefficient * normal_N_ * m_.wheel_radius_m[k] * shape;
  if (w_.stribeck_torque_Nm > 0) {
    const double ratio = speed / w_.stribeck_speed_rad_s;
    level += w_.stribeck_torque_Nm * std::exp(-std::pow(ratio, 2.0 + 2 * w_.form));
  }
  level += w_.drag_torque_Nm[k] * shape;
  if (wheel.speed_rad_s < 0) level += w_.reverse_torque_Nm * shape;
  level += w_.gear_loss_fraction * m_.torque_per_ampere_Nm_A() * std::abs(wheel.current_A) * shape;
  if (w_.grease_torque_Nm > 0) level += w_.grease_torque_Nm * std::exp(-day_s / w_.grease_time_s);
  if (w_.belt_set_torque_Nm > 0)
    level += w_.belt_set_torque_Nm * std::exp(-wheel.since_stop_rad / w_.belt_set_angle_rad);
  return level + m_.friction_torque_Nm[k] * (1 + w_.rolling_speed_slope_s_m * speed * m_.wheel_radius_m[k]);
}

/// All torques on a wheel except creep, back-EMF and viscous friction, which the step treats implicitly.
double Plant::wheel_torque(std::size_t k, double day_s) {
  Wheel& wheel = wheel_[k];
  const double q = wheel.speed_rad_s;
  double torque = m_.torque_per_ampere_Nm_A() * wheel.free_current_A;
  torque -= wheel.bristle.force(resisting_level(k, day_s), q, m_.presliding_angle_rad, d_.step_s);
  if (w_.cogging_per_rev > 0)
    torque +=
        w_.cogging_torque_Nm[k] * std::sin(w_.cogging_per_rev * wheel.angle_rad + w_.cogging_phase_rad[k]);
  if (w_.eccentric_torque_Nm[k] != 0) torque -= w_.eccentric_torque_Nm[k] * std::sin(wheel.angle_rad + 0.7);
  if (w_.flat_spot_torque_Nm[k] != 0) {
    const double off = std::remainder(wheel.angle_rad, 2 * std::numbers::pi) / 0.15;
    torque += w_.flat_spot_torque_Nm[k] * off * std::exp(-0.5 * off * off);  // climb, then fall
  }
  if (w_.eddy_torque_Nm > 0) {
    const double ratio = q / w_.eddy_speed_rad_s;
    torque -= w_.eddy_torque_Nm * 2 * ratio / (1 + ratio * ratio);
  }
  return torque;
}

Plant::BodyForces Plant::outer_forces(double day_s) {
  BodyForces f;
  const auto push = [&](double x_N, double y_N,
                        double ahead_m) {  // a force in map axes, at a point ahead of the axle
    const double c = std::cos(heading_rad_), s = std::sin(heading_rad_);
    f.forward_N += c * x_N + s * y_N;
    f.sideways_N += -s * x_N + c * y_N;
    f.yaw_Nm += ahead_m * (-s * x_N + c * y_N);
  };
  if (w_.slope_grade != 0) {
    const double undulation = 1 + w_.form * std::sin(1.3 * x_m_ + 0.9 * y_m_);
    const double pull = -mass_kg_ * kGravity_m_s2 * w_.slope_grade * undulation;
    push(pull * std::cos(w_.uphill_direction_rad), pull * std::sin(w_.uphill_direction_rad),
         moment_kg_m_ / mass_kg_);
  }
  if (w_.draft_force_N != 0) {
    const double pull = w_.draft_force_N * (0.2 + day_s / 400.0);
    push(pull * std::cos(w_.draft_direction_rad), pull * std::sin(w_.draft_direction_rad), 0);
  }
  if (w_.cable_N_m != 0) push(-w_.cable_N_m * x_m_, -w_.cable_N_m * y_m_, 0);
  if (w_.air_drag_N_s2_m2 > 0)
    f.forward_N -= w_.air_drag_N_s2_m2 * forward_ * std::pow(std::abs(forward_), 1.0 + w_.form);
  if (w_.scrub_moment_Nm > 0)
    f.yaw_Nm -= scrub_.force(w_.scrub_moment_Nm * (1 + w_.form * (std::abs(yaw_rate_) - 0.5)), yaw_rate_,
                             kScrubPresliding_rad, d_.step_s);
  if (w_.caster_moment_Nm > 0) f.yaw_Nm += caster_moment();
  if (w_.slosh_fraction > 0) f.forward_N += slosh_force();
  return f;
}

/// Casters that still point along the old course resist the turn into the new one. `caster_` is the remaining
/// part of the swivel: a change of course sets it, and it decays with the distance travelled.
double Plant::caster_moment() {
  const double reach_m = 1.2 * m_.half_track_m;  // the caster's mounting point, ahead of the axle
  const double speed = std::hypot(forward_, reach_m * yaw_rate_);
  if (speed > 5e-3) {
    const double course = std::atan2(reach_m * yaw_rate_, forward_);
    double turned = std::remainder(course - course_rad_, 2 * std::numbers::pi);
    if (std::abs(turned) > 2.6)
      turned = 0;  // straight back: the casters on both sides swivel in opposite directions, no moment
    course_rad_ = course;
    caster_ =
        std::clamp(caster_ + turned / 0.35, -1.0, 1.0) * std::exp(-speed * d_.step_s / w_.caster_trail_m);
  }
  return -w_.caster_moment_Nm * caster_;
}

/// A part of the payload on a spring, along the robot: its pull on the chassis.
double Plant::slosh_force() {
  const double part = payload_kg_ * w_.slosh_fraction;
  if (part <= 0) return 0.0;
  const double w = w_.slosh_frequency_rad_s, dt = d_.step_s;
  const double pull = part * (w * w * slosh_m_ + 2 * 0.08 * w * (slosh_speed_ - forward_));
  slosh_speed_ -= dt * pull / part;
  slosh_m_ += dt * (slosh_speed_ - forward_);
  return pull;
}

}  // namespace blind
