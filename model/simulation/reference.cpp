#include "model/simulation/reference.hpp"

#include <algorithm>
#include <cmath>

#include "model/config_error.hpp"

namespace joulepath {

Reference::Reference(const Geometry& geometry, const Trajectory& trajectory)
    : time_s_(trajectory.time_s),
      speed_m_s_(trajectory.linear_speed_m_s),
      yaw_rate_rad_s_(trajectory.angular_speed_rad_s),
      payload_kg_(trajectory.payload_kg) {
  const std::size_t size = trajectory.size();
  if (size < 2)
    throw ConfigError({.mark = {},
                       .key = "time_s",
                       .found = std::to_string(size) + " samples",
                       .accepted = "at least 2",
                       .hint = {}});
  if (speed_m_s_.size() != size || yaw_rate_rad_s_.size() != size) {
    if (trajectory.wheel_speed_rad_s.left.size() != size || trajectory.wheel_speed_rad_s.right.size() != size)
      throw ConfigError({.mark = {},
                         .key = "linear_speed_m_s",
                         .found = "nothing",
                         .accepted = "linear_speed_m_s and angular_speed_rad_s, or both wheel speeds",
                         .hint = {}});
    speed_m_s_.resize(size);
    yaw_rate_rad_s_.resize(size);
    for (std::size_t i = 0; i < size; ++i) {
      const Twist<double> twist = body_twist(geometry, Sided<double>{trajectory.wheel_speed_rad_s.left[i],
                                                                     trajectory.wheel_speed_rad_s.right[i]});
      speed_m_s_[i] = twist.speed_m_s;
      yaw_rate_rad_s_[i] = twist.yaw_rate_rad_s;
    }
  }
  start_at({});
}

void Reference::start_at(const Pose& pose) {
  pose_.assign(1, pose);
  for (std::size_t i = 0; i + 1 < time_s_.size(); ++i) {
    const double dt = time_s_[i + 1] - time_s_[i];
    const double half_rad = 0.25 * dt * (yaw_rate_rad_s_[i] + yaw_rate_rad_s_[i + 1]);
    const double travelled_m = 0.5 * dt * (speed_m_s_[i] + speed_m_s_[i + 1]);
    const double chord_m = travelled_m * (std::abs(half_rad) > 1e-6 ? std::sin(half_rad) / half_rad : 1.0);
    const Pose& at = pose_.back();
    pose_.push_back({at.x_m + chord_m * std::cos(at.heading_rad + half_rad),
                     at.y_m + chord_m * std::sin(at.heading_rad + half_rad), at.heading_rad + 2 * half_rad});
  }
}

bool Reference::ends_at_rest() const { return speed_m_s_.back() == 0.0 && yaw_rate_rad_s_.back() == 0.0; }

std::size_t Reference::interval(double time_s) {
  if (last_ + 1 >= time_s_.size() || time_s_[last_] > time_s) last_ = 0;
  while (last_ + 2 < time_s_.size() && time_s_[last_ + 1] <= time_s) ++last_;
  return last_;
}

BodyMotion<double> Reference::motion(double time_s) {
  if (time_s >= end_s()) return {.speed_m_s = speed_m_s_.back(), .yaw_rate_rad_s = yaw_rate_rad_s_.back()};
  const std::size_t k = interval(time_s);
  const double dt = time_s_[k + 1] - time_s_[k];
  const double u = std::max(0.0, time_s - time_s_[k]) / dt;
  const double dv = speed_m_s_[k + 1] - speed_m_s_[k];
  const double dw = yaw_rate_rad_s_[k + 1] - yaw_rate_rad_s_[k];
  return {speed_m_s_[k] + u * dv, dv / dt, yaw_rate_rad_s_[k] + u * dw, dw / dt};
}

double Reference::payload_kg(double time_s) {
  if (payload_kg_.empty()) return 0.0;
  return payload_kg_[time_s >= end_s() ? payload_kg_.size() - 1 : interval(time_s)];
}

Pose Reference::pose(double time_s) {
  if (time_s >= end_s()) return pose_.back();
  const std::size_t k = interval(time_s);
  const double u = std::max(0.0, time_s - time_s_[k]) / (time_s_[k + 1] - time_s_[k]);
  const auto mix = [u](double a, double b) { return a + u * (b - a); };
  return {mix(pose_[k].x_m, pose_[k + 1].x_m), mix(pose_[k].y_m, pose_[k + 1].y_m),
          mix(pose_[k].heading_rad, pose_[k + 1].heading_rad)};
}

}  // namespace joulepath
