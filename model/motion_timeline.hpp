#pragma once

#include <cmath>
#include <string>

#include "model/bezier_arc.hpp"
#include "model/config_error.hpp"
#include "model/kinematics.hpp"
#include "model/motions.hpp"

namespace joulepath {

/// A stretch of constant acceleration, along the path or about the vertical.
struct Ramp {
  double duration_s{};
  double start{};         ///< m/s or rad/s
  double acceleration{};  ///< m/s^2 or rad/s^2
};

[[noreturn]] inline void refuse_motion(const std::string& key, const std::string& found,
                                       const std::string& accepted) {
  throw ConfigError({.mark = {}, .key = "motion." + key, .found = found, .accepted = accepted, .hint = {}});
}

/// Payload during a motion.
inline double payload_kg_of(const TimingOptions& options, std::size_t motion) {
  return options.payload_of_motion_kg.empty() ? options.payload_kg : options.payload_of_motion_kg.at(motion);
}

/// Converts ramps to samples.
class Timeline {
 public:
  Timeline(const Robot& robot, const TimingOptions& options)
      : robot_(robot),
        options_(options),
        payload_kg_(payload_kg_of(options, 0)),
        pose_(options.start),
        time_s_(options.start_time_s) {
    append(0, 0, 0, 0);
  }

  /// The payload from here on.
  void load(double payload_kg) { payload_kg_ = payload_kg; }

  /// speed = rate * linear_share, yaw rate = rate * angular_share.
  void add(const Ramp& ramp, double linear_share, double angular_share) {
    if (ramp.duration_s <= 0) return;
    follow(
        ramp,
        [&](double rate, double) {
          return Twist<double>{rate * linear_share, rate * angular_share};
        },
        ramp.acceleration * linear_share);
  }

  /// Adds a ramp along a curve, from the place where the last ramp on it ended.
  void add_on_curve(const Ramp& ramp, const BezierArc& curve, double direction, double& place_m) {
    if (ramp.duration_s <= 0) return;
    const double from_m = place_m;
    follow(
        ramp,
        [&](double rate, double t) {
          place_m = from_m + t * (ramp.start + ramp.acceleration * t / 2);
          return Twist<double>{direction * rate, rate * curve.curvature_per_m(place_m)};
        },
        ramp.acceleration * direction);
  }

  double time_s() const { return time_s_; }
  TimedMotion& result() { return motion_; }

 private:
  template <class TwistAt>
  void follow(const Ramp& ramp, TwistAt&& twist_at, double acceleration_m_s2) {
    const double begin_s = time_s_;
    restart(twist_at(ramp.start, 0.0), acceleration_m_s2);
    const double period_s = options_.sample_period_s;
    double grid = std::floor(begin_s / period_s) + 1;
    for (bool last = false; !last; ++grid) {
      double t = grid * period_s - begin_s;
      if (t < 1e-9) continue;
      last = t > ramp.duration_s - 1e-9;
      if (last) t = ramp.duration_s;
      const Twist<double> twist = twist_at(ramp.start + ramp.acceleration * t, t);
      step(begin_s + t, twist, acceleration_m_s2);
    }
  }

  /// Gives the sample at the joint the values of the ramp that begins there.
  void restart(const Twist<double>& twist, double acceleration_m_s2) {
    Trajectory& t = motion_.trajectory;
    if (t.size() > 1 &&
        std::hypot(twist.speed_m_s - twist_.speed_m_s, twist.yaw_rate_rad_s - twist_.yaw_rate_rad_s) > 1e-6)
      refuse_motion(
          "start_speed_m_s", std::to_string(twist.speed_m_s) + " m/s",
          "the speed at which the motion before it ends, " + std::to_string(twist_.speed_m_s) + " m/s");
    twist_ = twist;
    const Sided<double> wheels = wheel_speeds_rad_s(robot_.geometry, twist.speed_m_s, twist.yaw_rate_rad_s);
    t.linear_speed_m_s.back() = twist.speed_m_s;
    t.angular_speed_rad_s.back() = twist.yaw_rate_rad_s;
    t.linear_acceleration_m_s2.back() = acceleration_m_s2;
    for (Side side : kSides) t.wheel_speed_rad_s[side].back() = wheels[side];
  }

  /// Moves the pose along the arc of constant curvature between two samples.
  void step(double time_s, const Twist<double>& next, double acceleration_m_s2) {
    const double dt = time_s - time_s_;
    const double travelled_m = 0.5 * (twist_.speed_m_s + next.speed_m_s) * dt;
    const double turned_rad = 0.5 * (twist_.yaw_rate_rad_s + next.yaw_rate_rad_s) * dt;
    const double half_rad = turned_rad / 2;
    const double chord_m = travelled_m * (std::abs(half_rad) > 1e-6 ? std::sin(half_rad) / half_rad : 1.0);
    pose_.x_m += chord_m * std::cos(pose_.heading_rad + half_rad);
    pose_.y_m += chord_m * std::sin(pose_.heading_rad + half_rad);
    pose_.heading_rad += turned_rad;
    arc_length_m_ += std::abs(travelled_m);
    time_s_ = time_s;
    twist_ = next;
    append(next.speed_m_s, next.yaw_rate_rad_s, acceleration_m_s2,
           next.speed_m_s != 0 ? next.yaw_rate_rad_s / next.speed_m_s : 0.0);
  }

  void append(double speed_m_s, double yaw_rate_rad_s, double acceleration_m_s2, double curvature_per_m) {
    Trajectory& t = motion_.trajectory;
    const Sided<double> wheels = wheel_speeds_rad_s(robot_.geometry, speed_m_s, yaw_rate_rad_s);
    t.time_s.push_back(time_s_);
    for (Side side : kSides) t.wheel_speed_rad_s[side].push_back(wheels[side]);
    t.linear_speed_m_s.push_back(speed_m_s);
    t.angular_speed_rad_s.push_back(yaw_rate_rad_s);
    t.linear_acceleration_m_s2.push_back(acceleration_m_s2);
    t.curvature_per_m.push_back(curvature_per_m);
    t.position_x_m.push_back(pose_.x_m);
    t.position_y_m.push_back(pose_.y_m);
    t.heading_rad.push_back(pose_.heading_rad);
    t.arc_length_m.push_back(arc_length_m_);
    t.payload_kg.push_back(payload_kg_);
  }

  const Robot& robot_;
  const TimingOptions& options_;
  double payload_kg_{};
  TimedMotion motion_{};
  Twist<double> twist_{};
  Pose pose_{};
  double time_s_{};
  double arc_length_m_{};
};

}  // namespace joulepath
