#include "model/motions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "model/bezier_arc.hpp"
#include "model/config_error.hpp"
#include "model/operating_point.hpp"

namespace joulepath {
namespace {

/// A stretch of constant acceleration, along the path or about the vertical.
struct Ramp {
  double duration_s{};
  double start{};         ///< m/s or rad/s
  double acceleration{};  ///< m/s^2 or rad/s^2
};

[[noreturn]] void refuse(const std::string& key, const std::string& found, const std::string& accepted) {
  throw ConfigError({.mark = {}, .key = "motion." + key, .found = found, .accepted = accepted, .hint = {}});
}

double positive(const std::string& key, const std::optional<double>& given, double otherwise = kNoLimit) {
  const double value = given.value_or(otherwise);
  if (!std::isfinite(value)) refuse(key, "nothing", "a number above 0");
  if (value <= 0) refuse(key, std::to_string(value), "a number above 0");
  return value;
}

/// Accelerates to `top`, cruises, brakes to rest, within `distance`; a triangle where there is no room.
std::vector<Ramp> trapezoid(double distance, double start, double top, double up, double down) {
  top = std::max(top, start);
  const double room = 2 * up * down / (up + down) * (distance + start * start / (2 * up));
  const double peak = std::min(top, std::sqrt(room));
  if (peak < start) refuse("distance_m", std::to_string(distance), "room to brake from the start speed");
  const double ramps = (peak * peak - start * start) / (2 * up) + peak * peak / (2 * down);
  return {{(peak - start) / up, start, up},
          {std::max(0.0, distance - ramps) / peak, peak, 0},
          {peak / down, peak, -down}};
}

/// Lays ramps out as samples.
class Timeline {
 public:
  Timeline(const Robot& robot, const TimingOptions& options)
      : robot_(robot), options_(options), pose_(options.start), time_s_(options.start_time_s) {
    append(0, 0, 0, 0);
  }

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

  /// Along a curve, from where the last ramp on it ended.
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

  /// What the sample at the joint says belongs to the ramp that begins there.
  void restart(const Twist<double>& twist, double acceleration_m_s2) {
    Trajectory& t = motion_.trajectory;
    if (t.size() > 1 &&
        std::hypot(twist.speed_m_s - twist_.speed_m_s, twist.yaw_rate_rad_s - twist_.yaw_rate_rad_s) > 1e-6)
      refuse("start_speed_m_s", std::to_string(twist.speed_m_s) + " m/s",
             "the speed at which the motion before it ends, " + std::to_string(twist_.speed_m_s) + " m/s");
    twist_ = twist;
    const Sided<double> wheels = wheel_speeds_rad_s(robot_.geometry, twist.speed_m_s, twist.yaw_rate_rad_s);
    t.linear_speed_m_s.back() = twist.speed_m_s;
    t.angular_speed_rad_s.back() = twist.yaw_rate_rad_s;
    t.linear_acceleration_m_s2.back() = acceleration_m_s2;
    for (Side side : kSides) t.wheel_speed_rad_s[side].back() = wheels[side];
  }

  /// Along the arc of constant curvature between two samples.
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
    t.payload_kg.push_back(options_.payload_kg);
  }

  const Robot& robot_;
  const TimingOptions& options_;
  TimedMotion motion_{};
  Twist<double> twist_{};
  Pose pose_{};
  double time_s_{};
  double arc_length_m_{};
};

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
    if (!motion.yaw_rate_rad_s) refuse("yaw_rate_rad_s", "nothing", "a yaw rate, or an angle_rad");
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
      if (!motion.angle_rad) refuse("angle_rad", "nothing", "the angle to turn by");
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
  for (const PrescribedMotion& motion : motions)
    for (int k = 0; k < motion.repeat; ++k) add_motion(robot, plant, motion, options.payload_kg, timeline);
  return std::move(timeline.result());
}

}  // namespace joulepath
