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

}  // namespace joulepath
