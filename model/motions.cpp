#include "model/motions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "model/motion_timeline.hpp"
#include "model/operating_point.hpp"

namespace joulepath {
namespace {

double positive(const std::string& key, const std::optional<double>& given, double otherwise = kNoLimit) {
  const double value = given.value_or(otherwise);
  if (!std::isfinite(value)) refuse_motion(key, "nothing", "a number above 0");
  if (value <= 0) refuse_motion(key, std::to_string(value), "a number above 0");
  return value;
}

/// Accelerates to `top`, cruises, brakes to rest, within `distance`; a triangle where there is no room.
std::vector<Ramp> trapezoid(double distance, double start, double top, double up, double down) {
  top = std::max(top, start);
  const double room = 2 * up * down / (up + down) * (distance + start * start / (2 * up));
  const double peak = std::min(top, std::sqrt(room));
  if (peak < start)
    refuse_motion("distance_m", std::to_string(distance), "room to brake from the start speed");
  const double ramps = (peak * peak - start * start) / (2 * up) + peak * peak / (2 * down);
  return {{(peak - start) / up, start, up},
          {std::max(0.0, distance - ramps) / peak, peak, 0},
          {peak / down, peak, -down}};
}

/// Ramps along a path: constant_ramp, constant_speed, trapezoid, arc.
std::vector<Ramp> path_ramps(const PrescribedMotion& motion, const Limits& limits, double path_length_m) {
  const double start = motion.start_speed_m_s.value_or(0.0);
  if (motion.profile == MotionProfile::constant_speed) {
    const double speed = positive("speed_m_s", motion.speed_m_s, limits.speed_m_s);
    if (motion.duration_s) return {{positive("duration_s", motion.duration_s), speed, 0}};
    return {{positive("distance_m", motion.distance_m, path_length_m) / speed, speed, 0}};
  }
  const double up = positive("acceleration_m_s2", motion.acceleration_m_s2, limits.acceleration_m_s2);
  const double down = positive("deceleration_m_s2", motion.deceleration_m_s2,
                               motion.acceleration_m_s2 ? up : limits.deceleration_m_s2);
  if (motion.profile == MotionProfile::constant_ramp) {
    const double ramp_s = positive("ramp_s", motion.ramp_s);
    const double top = start + up * ramp_s;
    if (!motion.distance_m && !std::isfinite(path_length_m))
      return {{ramp_s, start, up}, {top / down, top, -down}};
    return trapezoid(positive("distance_m", motion.distance_m, path_length_m), start, top, up, down);
  }
  const double top = positive("speed_m_s", motion.speed_m_s, limits.speed_m_s);
  return trapezoid(positive("distance_m", motion.distance_m, path_length_m), start, top, up, down);
}

std::vector<Ramp> spin_ramps(const PrescribedMotion& motion, const Limits& limits) {
  if (!motion.angle_rad) {
    if (!motion.yaw_rate_rad_s) refuse_motion("yaw_rate_rad_s", "nothing", "a yaw rate, or an angle_rad");
    return {{positive("duration_s", motion.duration_s), std::abs(*motion.yaw_rate_rad_s), 0}};
  }
  const std::optional<double> asked =
      motion.yaw_rate_rad_s ? std::optional(std::abs(*motion.yaw_rate_rad_s)) : std::nullopt;
  const double top = positive("yaw_rate_rad_s", asked, limits.yaw_rate_rad_s);
  const double ramp =
      positive("yaw_acceleration_rad_s2", motion.yaw_acceleration_rad_s2, limits.yaw_acceleration_rad_s2);
  return trapezoid(std::abs(*motion.angle_rad), 0.0, top, ramp, ramp);
}

/// Deceleration (m/s^2, negative) of a robot that rolls straight on with no current in its motors.
double coasting_acceleration_m_s2(const Plant& plant, double speed_m_s, double direction, const Pose& pose,
                                  double payload_kg) {
  const Robot& robot = plant.robot;
  const MassProperties mass = mass_properties(robot, plant.payload_kg(payload_kg));
  const double v = direction * speed_m_s;
  const Site site = site_of(robot.geometry, pose, payload_kg, direction, 0.0);
  double force_N = effect_load(plant, mass, v, 0.0, site).force_N;
  double mass_kg = mass.mass_kg;
  for (Side side : kSides) {
    const double r = robot.geometry.wheel_radius_m[side];
    force_N += shaft_friction_Nm(plant, mass, side, v / r, site) / r;
    mass_kg += robot.inertia.wheel_axle_inertia_kg_m2 / (r * r);
  }
  return -direction * force_N / mass_kg;
}

void coast(const PrescribedMotion& motion, const Plant& plant, double direction, double payload_kg,
           Timeline& timeline) {
  constexpr double kStep_s = 0.005;
  double speed = positive("speed_m_s", motion.speed_m_s, motion.start_speed_m_s.value_or(kNoLimit));
  const double end_s = motion.duration_s.value_or(600.0);
  const double from_s = timeline.time_s();
  for (double t = 0; t < end_s && speed > 0; t += kStep_s) {
    const Trajectory& past = timeline.result().trajectory;
    const Pose pose{past.position_x_m.back(), past.position_y_m.back(), past.heading_rad.back()};
    const double a1 = coasting_acceleration_m_s2(plant, speed, direction, pose, payload_kg);
    const double a = coasting_acceleration_m_s2(plant, std::max(0.0, speed + a1 * kStep_s / 2), direction,
                                                pose, payload_kg);
    double step_s = std::min(kStep_s, end_s - t);
    if (speed + a * step_s < 0) step_s = -speed / a;
    timeline.add({step_s, speed, a}, direction, 0);
    if (step_s < kStep_s) break;
    speed += a * step_s;
  }
  timeline.result().coasting.push_back({from_s, timeline.time_s()});
}

void add_motion(const Robot& robot, const Plant& plant, const PrescribedMotion& motion, double payload_kg,
                Timeline& timeline) {
  const Limits limits = robot.limits.value_or(Limits{});
  const double direction = motion.reverse ? -1.0 : 1.0;
  switch (motion.profile) {
    case MotionProfile::stand:
      return timeline.add({positive("duration_s", motion.duration_s), 0, 0}, 0, 0);
    case MotionProfile::coast:
      return coast(motion, plant, direction, payload_kg, timeline);
    case MotionProfile::spin: {
      const double turn = sign_of(motion.angle_rad.value_or(motion.yaw_rate_rad_s.value_or(1.0)));
      for (const Ramp& ramp : spin_ramps(motion, limits)) timeline.add(ramp, 0, turn);
      return;
    }
    case MotionProfile::arc: {
      const double radius_m = positive("radius_m", motion.radius_m);
      if (!motion.angle_rad) refuse_motion("angle_rad", "nothing", "the angle to turn by");
      const double length_m = std::abs(*motion.angle_rad) * radius_m;
      for (const Ramp& ramp : path_ramps(motion, limits, length_m))
        timeline.add(ramp, direction, sign_of(*motion.angle_rad) / radius_m);
      return;
    }
    default:
      if (motion.bezier_m.empty()) {
        for (const Ramp& ramp : path_ramps(motion, limits, kNoLimit)) timeline.add(ramp, direction, 0);
        return;
      }
      const BezierArc curve(motion.bezier_m);
      double place_m = 0;
      for (const Ramp& ramp : path_ramps(motion, limits, curve.length_m()))
        timeline.add_on_curve(ramp, curve, direction, place_m);
  }
}

}  // namespace

TimedMotion timed_motion(const Robot& robot, const std::vector<PrescribedMotion>& motions,
                         const TimingOptions& options) {
  const Plant plant = make_plant(robot);
  Timeline timeline(robot, options);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const double payload_kg = payload_kg_of(options, i);
    timeline.load(payload_kg);
    for (int k = 0; k < motions[i].repeat; ++k) add_motion(robot, plant, motions[i], payload_kg, timeline);
  }
  return std::move(timeline.result());
}

}  // namespace joulepath
