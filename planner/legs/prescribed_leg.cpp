#include "planner/legs/prescribed_leg.hpp"

#include <algorithm>
#include <cmath>

#include "model/motions.hpp"
#include "planner/legs/leg_motion.hpp"

namespace joulepath {

EnergyByCause prescribed_energy(const LegPlan& leg, const Plant& plant) {
  if (leg.prescribed->size() == 0) return {};
  const SampledMotion motion = prescribed_motion(leg, plant);
  return energy_between(motion, motion.start_s(), motion.end_s());
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
