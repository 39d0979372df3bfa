#include "model/sampled_motion.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath {
namespace {

/// The interval of a sample time: 0 before the first sample, the last interval after the last sample.
std::size_t interval_of(const std::vector<double>& times_s, double time_s) {
  const auto after = std::upper_bound(times_s.begin(), times_s.end(), time_s);
  const std::size_t last = times_s.size() - 1;
  return std::min<std::size_t>(
      last == 0 ? 0 : last - 1,
      after == times_s.begin() ? 0 : static_cast<std::size_t>(after - times_s.begin()) - 1);
}

}  // namespace

SampledState sampled_state(const Trajectory& trajectory, double time_s) {
  const std::vector<double>& times_s = trajectory.time_s;
  const std::size_t k = interval_of(times_s, time_s), next = std::min(k + 1, times_s.size() - 1);
  const double length_s = times_s[next] - times_s[k];
  const double u = length_s > 0 ? std::clamp((time_s - times_s[k]) / length_s, 0.0, 1.0) : 0.0;
  const auto between = [&](const std::vector<double>& channel) {
    return channel.empty() ? 0.0 : channel[k] + u * (channel[next] - channel[k]);
  };
  const auto slope = [&](const std::vector<double>& channel) {
    return channel.empty() || length_s <= 0 || time_s > times_s.back()
               ? 0.0
               : (channel[next] - channel[k]) / length_s;
  };
  return {.motion = {between(trajectory.linear_speed_m_s), slope(trajectory.linear_speed_m_s),
                     between(trajectory.angular_speed_rad_s), slope(trajectory.angular_speed_rad_s)},
          .pose = {between(trajectory.position_x_m), between(trajectory.position_y_m),
                   between(trajectory.heading_rad)},
          .arc_length_m = between(trajectory.arc_length_m),
          .curvature_per_m = between(trajectory.curvature_per_m)};
}

Pose end_pose(const Trajectory& trajectory) {
  return sampled_state(trajectory, trajectory.time_s.back()).pose;
}

bool clear_standing(const Geometry& geometry, const BodyMotion<double>& motion, double standing_rad_s,
                    Site& site) {
  const Sided<double> wheels = wheel_speeds_rad_s(geometry, motion.speed_m_s, motion.yaw_rate_rad_s);
  bool stands = true;
  for (Side side : kSides) {
    if (std::abs(wheels[side]) < standing_rad_s)
      site.wheel_direction[side] = 0;
    else
      stands = false;
  }
  if (std::abs(geometry.half_track_m * motion.yaw_rate_rad_s) <
      standing_rad_s * std::min(geometry.wheel_radius_m.left, geometry.wheel_radius_m.right))
    site.turn_direction = 0;
  return stands;
}

SampledMotion::SampledMotion(const Plant& plant, const Trajectory& trajectory, const SampledStart& start)
    : plant_(&plant), trajectory_(&trajectory), start_(start) {
  if (!remembers(plant) || trajectory.size() == 0) return;
  memory_.assign(1, start.memory);
  for (std::size_t k = 0; k + 1 < trajectory.size(); ++k) {
    memory_.push_back(memory_.back());
    advance(trajectory.time_s[k], trajectory.time_s[k + 1], memory_.back());
  }
}

std::size_t SampledMotion::interval(double time_s) const { return interval_of(trajectory_->time_s, time_s); }

void SampledMotion::advance(double from_s, double to_s, EffectMemory& memory) const {
  constexpr int kSteps = 4;
  advance_memory_along(
      *plant_,
      [&](double time_s) {
        const BodyMotion<double> motion = sampled_state(*trajectory_, time_s).motion;
        return Twist<double>{motion.speed_m_s, motion.yaw_rate_rad_s};
      },
      from_s, to_s, kSteps, memory);
}

EffectMemory SampledMotion::memory(double time_s) const {
  if (memory_.empty()) return start_.memory;
  const std::size_t k = interval(time_s);
  EffectMemory memory = memory_[k];
  advance(trajectory_->time_s[k], std::clamp(time_s, trajectory_->time_s[k], trajectory_->time_s.back()),
          memory);
  return memory;
}

MotionInstant SampledMotion::at(double time_s) const {
  const SampledState state = sampled_state(*trajectory_, time_s);
  const Geometry& geometry = plant_->robot.geometry;
  const double payload_kg =
      trajectory_->payload_kg.empty() ? start_.payload_kg : trajectory_->payload_kg[interval(time_s)];
  MotionInstant instant{
      .motion = state.motion,
      .site = site_of(geometry, state.pose, payload_kg, state.motion.speed_m_s, state.motion.yaw_rate_rad_s,
                      start_.time_of_day_s + time_s - trajectory_->time_s.front())};
  instant.stands = clear_standing(geometry, state.motion, start_.standing_rad_s, instant.site);
  if (!memory_.empty()) instant.site.memory = memory(time_s);
  return instant;
}

EnergyByCause energy_between(const SampledMotion& motion, double from_s, double to_s) {
  EnergySum sum(motion.plant());
  motion.integrate_between(from_s, to_s, [&](const EnergyNode& node) { sum.add(node); });
  return sum.by_cause();
}

}  // namespace joulepath
