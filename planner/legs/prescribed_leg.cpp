#include "planner/legs/prescribed_leg.hpp"

#include <algorithm>
#include <cmath>

#include "model/motions.hpp"

namespace joulepath {
SampledState sampled_state(const Trajectory& trajectory, double time_s) {
  const std::vector<double>& times_s = trajectory.time_s;
  const auto after = std::upper_bound(times_s.begin(), times_s.end(), time_s);
  const std::size_t last = times_s.size() - 1;
  const std::size_t k = std::min<std::size_t>(
      last == 0 ? 0 : last - 1,
      after == times_s.begin() ? 0 : static_cast<std::size_t>(after - times_s.begin()) - 1);
  const std::size_t next = std::min(k + 1, last);
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

EnergyByCause prescribed_energy(const LegPlan& leg, const Plant& plant, double from_s, double to_s) {
  const Trajectory& motion = *leg.prescribed;
  from_s += motion.time_s.front();
  to_s += motion.time_s.front();
  constexpr double kNode = 0.7745966692414834;
  constexpr struct { double x, weight; } kGauss[] = {{-kNode, 5.0 / 18}, {0.0, 8.0 / 18}, {kNode, 5.0 / 18}};
  EnergyByCause energy;
  for (std::size_t k = 0; k + 1 < motion.size(); ++k) {
    const double begin_s = std::max(from_s, motion.time_s[k]);
    const double length_s = std::min(to_s, motion.time_s[k + 1]) - begin_s;
    if (!(length_s > 0)) continue;
    for (const auto& gauss : kGauss) {
      const double time_s = begin_s + 0.5 * (1 + gauss.x) * length_s;
      const SampledState state = sampled_state(motion, time_s);
      const Site site = site_of(plant.robot.geometry, state.pose, leg.payload.from_kg, state.motion.speed_m_s,
                                state.motion.yaw_rate_rad_s, time_s);
      energy.add(plant, power_by_cause(plant, state.motion, site), gauss.weight * length_s);
    }
  }
  return energy;
}

LegPlan prescribed_leg(const LegRequest& leg, const Plant& plant, const Pose& start) {
  LegPlan planned{.to = "motion",
                  .path_source = "prescribed",
                  .status = SolveStatus::feasible,
                  .payload = leg.payload,
                  .dwell_s = leg.dwell_s};
  try {
    planned.prescribed =
        timed_motion(plant.robot, {*leg.motion}, {.start = start, .payload_kg = leg.payload.from_kg})
            .trajectory;
  } catch (const ConfigError& error) {
    ConfigError::Detail detail = error.detail();
    detail.mark = leg.marks.at("motion");
    detail.key = leg.marks.key_path(detail.key.empty() ? "motion" : detail.key);
    throw ConfigError(detail);
  }
  const Trajectory& motion = *planned.prescribed;
  if (motion.size() == 0) return planned;
  planned.duration_s = motion.time_s.back() - motion.time_s.front();
  if (!motion.arc_length_m.empty()) planned.distance_m = motion.arc_length_m.back();
  planned.energy = prescribed_energy(planned, plant, 0.0, planned.duration_s);
  planned.energy.standby_J += plant.robot.power.standby_W * leg.dwell_s;
  return planned;
}

std::optional<Infeasibility> broken_limit(const LegPlan& leg, const Plant& plant, const Limits& limits) {
  constexpr double kTolerance = 1e-6;
  std::optional<Infeasibility> worst;
  double worst_ratio = 1.0 + kTolerance;
  const Trajectory& motion = *leg.prescribed;
  for (std::size_t k = 0; k + 1 < motion.size(); ++k)
    for (const double u : {1e-6, 1.0 - 1e-6}) {
      const SampledState state =
          sampled_state(motion, motion.time_s[k] + u * (motion.time_s[k + 1] - motion.time_s[k]));
      const BodyMotion<double>& body = state.motion;
      const auto check = [&](const char* name, double value, double limit, const char* unit) {
        if (!(std::abs(value) > worst_ratio * limit)) return;
        worst_ratio = std::abs(value) / limit;
        worst = Infeasibility{.constraint = name,
                              .s = state.arc_length_m,
                              .x_m = state.pose.x_m,
                              .y_m = state.pose.y_m,
                              .amount = std::abs(value) - limit,
                              .unit = unit,
                              .relaxation = {{std::string(name) + "_limit", std::abs(value)}},
                              .message = std::string("the prescribed motion exceeds the limit of ") + name};
      };
      check("speed", body.speed_m_s, limits.speed_m_s, "m/s");
      const bool faster = body.acceleration_m_s2 * body.speed_m_s >= 0;
      check(faster ? "acceleration" : "deceleration", body.acceleration_m_s2,
            faster ? limits.acceleration_m_s2 : limits.deceleration_m_s2, "m/s^2");
      check("yaw_rate", body.yaw_rate_rad_s, limits.yaw_rate_rad_s, "rad/s");
      check("yaw_acceleration", body.yaw_acceleration_rad_s2, limits.yaw_acceleration_rad_s2, "rad/s^2");
      check("lateral_acceleration", body.speed_m_s * body.yaw_rate_rad_s, limits.lateral_acceleration_m_s2,
            "m/s^2");
      const Site site =
          site_of(plant.robot.geometry, state.pose, leg.payload.from_kg, body.speed_m_s, body.yaw_rate_rad_s);
      const Sided<WheelState<double>> wheels = operating_point(plant, body, site);
      for (const Side side : kSides) {
        check("motor_voltage", wheels[side].voltage_V, plant.robot.motor[side].max_voltage_V, "V");
        check("motor_current", wheels[side].current_A, plant.robot.motor[side].max_current_A, "A");
        check("motor_power", wheels[side].power_W, limits.motor_power_W, "W");
      }
    }
  return worst;
}

}  // namespace joulepath
