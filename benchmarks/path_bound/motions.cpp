#include "benchmarks/path_bound/motions.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace joulepath::path_bound {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kNodes = 240;  ///< of a motion
constexpr double kRounding = 1e-9;

double sign(double x) { return (x > 0) - (x < 0); }

/// Watts at the battery's terminals.
double power_W(const JudgeRobot& p, double v, double w, double a, double alpha) {
  const double mass = p.chassis_kg + 2 * p.wheel_kg + p.payload_kg,
               moment = (p.chassis_kg + p.payload_kg) * p.center_of_mass_m;
  const double inertia = p.chassis_yaw_kg_m2 + p.payload_yaw_m2 * p.payload_kg +
                         (p.chassis_kg + p.payload_kg) * p.center_of_mass_m * p.center_of_mass_m +
                         2 * p.wheel_kg * p.half_track_m * p.half_track_m + 2 * p.wheel_yaw_kg_m2;
  const double force = mass * a - moment * w * w, torque = inertia * alpha + moment * v * w;
  double sum = 0, kept = 0;
  for (const int side : {-1, 1}) {
    const double spin = (v + side * p.half_track_m * w) / p.wheel_radius_m,
                 spin_up = (a + side * p.half_track_m * alpha) / p.wheel_radius_m;
    const double load = p.wheel_radius_m * (force / 2 + side * torque / (2 * p.half_track_m)) +
                        p.wheel_spin_kg_m2 * spin_up + p.viscous * spin +
                        (side < 0 ? p.friction_left : p.friction_right) * sign(spin);
    const double amps = load / (p.torque_constant * p.gear),
                 watts = amps * (p.resistance_ohm * amps + p.voltage_constant * p.gear * spin);
    sum += watts, kept += watts > 0 ? watts : p.regeneration * watts;
  }
  return p.standby_W + (p.bus ? (sum > 0 ? sum : p.regeneration * sum) : kept);
}

/// Speed of the cheapest long drive.
double cheapest_m_s(const JudgeRobot& robot) {
  double best = robot.speed, least = 1e300;
  for (int k = 1; k <= 200; ++k) {
    const double v = robot.speed * k / 200, rate = power_W(robot, v, 0, 0, 0) / v;
    if (rate < least) least = rate, best = v;
  }
  return best;
}

/// Speed over time: up to a top, on at it, coasting, braking. The time at the top makes up the way.
struct SpeedShape {
  double up{}, top{}, coast{}, coast_to{}, down{};
  double time_s(double way_m, double* at_top_s) const {
    const double ramps_m = top * top / (2 * up) + (top * top - coast_to * coast_to) / (2 * coast) +
                           coast_to * coast_to / (2 * down);
    *at_top_s = std::max(0.0, (way_m - ramps_m) / top);
    return top / up + *at_top_s + (top - coast_to) / coast + coast_to / down;
  }
};

SpeedShape fitted(SpeedShape shape, double way_m) {
  double at_top_s = 0;
  for (int k = 0; k < 60; ++k) {
    shape.time_s(way_m, &at_top_s);
    if (at_top_s > 0) break;
    shape.top *= 0.97, shape.coast_to *= 0.97;
  }
  return shape;
}

/// The times at which a speed shape bends, filled up.
Motion along(const SpeedShape& shape, double way_m, const std::string& kind) {
  double at_top_s = 0;
  const double total_s = shape.time_s(way_m, &at_top_s), t1 = shape.top / shape.up, t2 = t1 + at_top_s,
               t3 = t2 + (shape.top - shape.coast_to) / shape.coast;
  std::vector<double> times{0, t1, t2, t3, total_s};
  for (int k = 1; k < kNodes; ++k) times.push_back(total_s * k / kNodes);
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end(), [](double a, double b) { return b - a < 1e-9; }),
              times.end());
  Motion motion{.kind = kind, .time_s = times};
  for (double t : times)
    motion.speed_m_s.push_back(t <= t1   ? shape.up * t
                               : t <= t2 ? shape.top
                               : t <= t3 ? shape.top - shape.coast * (t - t2)
                                         : std::max(0.0, shape.coast_to - shape.down * (t - t3)));
  motion.speed_m_s.back() = 0;
  motion.yaw_rate_rad_s.assign(times.size(), 0);
  return motion;
}

/// Scales the yaw rate down until every limit holds.
void keep_limits(const JudgeRobot& robot, Motion& motion) {
  std::vector<double>& w = motion.yaw_rate_rad_s;
  w.front() = w.back() = 0;
  double scale = 1;
  for (std::size_t k = 0; k < w.size(); ++k) {
    const double size = std::abs(w[k]), v = std::abs(motion.speed_m_s[k]);
    scale =
        std::min({scale, robot.yaw_rate / std::max(size, 1e-9), robot.lateral / std::max(size * v, 1e-9)});
    if (k > 0) {
      const double alpha = std::abs(w[k] - w[k - 1]) / (motion.time_s[k] - motion.time_s[k - 1]);
      scale = std::min(scale, robot.yaw_acceleration / std::max(alpha, 1e-9));
    }
  }
  for (double& x : w) x *= scale * (1 - 1e-6);
}

void add_yaw(Motion& motion, const std::function<double(double share, double speed)>& yaw) {
  for (std::size_t k = 0; k < motion.time_s.size(); ++k)
    motion.yaw_rate_rad_s[k] += yaw(motion.time_s[k] / motion.time_s.back(), motion.speed_m_s[k]);
}

/// A turn in place before the motion.
void turn_first(const JudgeRobot& robot, Motion& motion, double angle_rad, double share_of_rate) {
  const double rate =
      std::min(share_of_rate * robot.yaw_rate, std::sqrt(std::abs(angle_rad) * robot.yaw_acceleration));
  const double ramp_s = rate / robot.yaw_acceleration, hold_s = std::abs(angle_rad) / rate - ramp_s,
               total_s = 2 * ramp_s + hold_s;
  Motion turn{.kind = motion.kind + ", after a turn in place",
              .time_s = {0, ramp_s, ramp_s + hold_s},
              .speed_m_s = {0, 0, 0},
              .yaw_rate_rad_s = {0, sign(angle_rad) * rate, sign(angle_rad) * rate}};
  for (std::size_t k = 0; k < motion.time_s.size(); ++k) {
    turn.time_s.push_back(total_s + motion.time_s[k]);
    turn.speed_m_s.push_back(motion.speed_m_s[k]), turn.yaw_rate_rad_s.push_back(motion.yaw_rate_rad_s[k]);
  }
  motion = turn;
}

/// Deceleration at which the motors carry no current on a straight line.
double coasting(const JudgeRobot& robot, double v) {
  double low = 0, high = robot.deceleration;
  const auto current = [&](double a) {
    JudgeRobot free = robot;
    free.regeneration = 1, free.bus = true;
    return power_W(free, v, 0, -a, 0) - robot.standby_W;
  };
  if (current(high) > 0) return high;
  for (int k = 0; k < 40; ++k) (current(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
  return std::max(0.05 * robot.deceleration, 0.5 * (low + high));
}

SpeedShape cheap_shape(const JudgeRobot& robot, double way_m) {
  const double top = cheapest_m_s(robot);
  return fitted({robot.acceleration, top, coasting(robot, 0.5 * top), 0.5 * top, robot.deceleration}, way_m);
}

}  // namespace

Driven drive(const JudgeRobot& robot, const Motion& motion) {
  constexpr double kPoint = 0.7745966692414834;  // sqrt(3/5)
  constexpr std::array<double, 3> kAt{0.5 * (1 - kPoint), 0.5, 0.5 * (1 + kPoint)},
      kWeight{5.0 / 18, 8.0 / 18, 5.0 / 18};
  Driven driven{.duration_s = motion.time_s.back(), .within_limits = true};
  const double more = 1 + kRounding;
  for (std::size_t k = 0; k + 1 < motion.time_s.size(); ++k) {
    const double dt = motion.time_s[k + 1] - motion.time_s[k];
    const double v0 = motion.speed_m_s[k], v1 = motion.speed_m_s[k + 1], w0 = motion.yaw_rate_rad_s[k],
                 w1 = motion.yaw_rate_rad_s[k + 1];
    const double a = (v1 - v0) / dt, alpha = (w1 - w0) / dt;
    const double gain = (std::abs(v1) - std::abs(v0)) / dt;
    driven.within_limits &= gain <= robot.acceleration * more && -gain <= robot.deceleration * more &&
                            std::abs(alpha) <= robot.yaw_acceleration * more &&
                            std::abs(v1) <= robot.speed * more && std::abs(w1) <= robot.yaw_rate * more &&
                            std::abs(v1 * w1) <= robot.lateral * more;
    const int parts =
        std::clamp(static_cast<int>(std::ceil(40 * (std::abs(v1 - v0) + std::abs(w1 - w0)))), 1, 20);
    for (int j = 0; j < parts; ++j)
      for (std::size_t i = 0; i < kAt.size(); ++i) {
        const double t = dt * (j + kAt[i]) / parts, h = dt * kWeight[i] / parts, v = v0 + a * t,
                     w = w0 + alpha * t;
        const double heading = driven.heading_rad + w0 * t + 0.5 * alpha * t * t;
        driven.energy_J += h * power_W(robot, v, w, a, alpha);
        driven.way_m += h * std::abs(v);
        driven.x_m += h * v * std::cos(heading), driven.y_m += h * v * std::sin(heading);
      }
    driven.heading_rad += 0.5 * dt * (w0 + w1);
  }
  return driven;
}

Motion random_motion(const JudgeRobot& robot, double way_m, std::mt19937& random) {
  const auto uniform = [&](double from, double to) {
    return from + (to - from) * (static_cast<double>(random()) / 4294967296.0);
  };
  const auto size = [&](double typical) {
    return typical * std::exp(uniform(-1.5, 1.0)) * (random() % 2 ? 1 : -1);
  };
  SpeedShape shape = cheap_shape(robot, way_m);
  if (random() % 3 == 0) {  // a small change of the cheapest straight motion
    shape.top = std::min(robot.speed, shape.top * uniform(0.9, 1.1));
    shape.coast_to = shape.top * std::clamp(shape.coast_to / shape.top + uniform(-0.2, 0.2), 0.05, 0.95);
    Motion motion = along(fitted(shape, way_m), way_m, "nearly straight");
    const double waves = size(0.05), count = uniform(0.5, 3), phase = uniform(0, 2 * kPi);
    add_yaw(motion, [&](double t, double v) { return v * waves * std::sin(2 * kPi * count * t + phase); });
    keep_limits(robot, motion);
    return motion;
  }
  shape.up *= uniform(0.3, 1), shape.down *= uniform(0.5, 1), shape.coast *= uniform(0.5, 1.5);
  shape.top = robot.speed * uniform(0.15, 1), shape.coast_to = shape.top * uniform(0.1, 0.9);
  shape.coast = std::min(shape.coast, robot.deceleration);
  Motion motion = along(fitted(shape, way_m), way_m, "");
  const double one = size(1.0), two = size(1.5), where = uniform(0, 1), width = uniform(0.03, 0.3),
               count = uniform(0.3, 4), phase = uniform(0, 2 * kPi);
  switch (random() % 6) {
    case 0:
      motion.kind = "waves";
      add_yaw(motion, [&](double t, double v) { return v * one * std::sin(2 * kPi * count * t + phase); });
      break;
    case 1:
      motion.kind = "hooks";
      add_yaw(motion, [&](double t, double) {
        return one * std::exp(-t / width) + two * std::exp(-(1 - t) / width);
      });
      break;
    case 2:
      motion.kind = "spins up and down";
      add_yaw(motion, [&](double t, double) { return two * std::min({1.0, t / width, (1 - t) / width}); });
      break;
    case 3:
      motion.kind = "one bend";
      add_yaw(motion, [&](double t, double) { return two * std::exp(-std::pow((t - where) / width, 2)); });
      break;
    case 4:
      motion.kind = "with a cusp";
      for (std::size_t k = 0; k < motion.time_s.size(); ++k) motion.speed_m_s[k] *= -1;
      add_yaw(motion, [&](double t, double v) { return v * two * std::sin(kPi * t); });
      if (where < 0.5) {
        Motion on = along(fitted(shape, way_m * where), way_m * where + 0.02, "");
        for (std::size_t k = 1; k < on.time_s.size(); ++k) {
          motion.time_s.push_back(motion.time_s.back() + on.time_s[k] - on.time_s[k - 1]);
          motion.speed_m_s.push_back(on.speed_m_s[k]), motion.yaw_rate_rad_s.push_back(0);
        }
      }
      break;
    default:
      motion.kind = "bend";
      add_yaw(motion, [&](double, double v) { return v * one; });
  }
  keep_limits(robot, motion);
  if (random() % 5 == 0)
    turn_first(robot, motion, uniform(0.2, kPi) * (random() % 2 ? 1 : -1), uniform(0.3, 1));
  return motion;
}

std::vector<Motion> worst_motions(const JudgeRobot& robot, double way_m) {
  std::vector<Motion> motions;
  const SpeedShape cheap = cheap_shape(robot, way_m);
  for (double share : {0.85, 0.95, 1.0, 1.05})
    for (double to : {0.2, 0.4, 0.6, 0.8}) {
      SpeedShape shape = cheap;
      shape.top = std::min(robot.speed, share * cheap.top), shape.coast_to = to * shape.top;
      motions.push_back(along(fitted(shape, way_m), way_m, "straight"));
    }
  const std::size_t straight = motions.size();
  for (double turn : {-1.0, 1.0})
    for (std::size_t k = 0; k < straight; k += 3) {
      // Rotation that is bought while the robot accelerates and drives it while it brakes; and the converse.
      for (const bool late : {false, true})
        for (double part : {0.15, 0.4, 0.7}) {
          Motion motion = motions[k];
          motion.kind = late ? "rotates while it brakes" : "rotates at first";
          add_yaw(motion, [&](double t, double) {
            const double u = late ? 1 - t : t;
            return turn * robot.yaw_rate *
                   std::max(0.0, std::min(u / (0.3 * part), (part - u) / (0.7 * part)));
          });
          keep_limits(robot, motion);
          motions.push_back(motion);
        }
      // One wheel stands still, or rolls backward, while the robot is slow.
      for (double beyond : {0.98, 1.02, 1.3}) {
        Motion motion = motions[k];
        motion.kind = "about a wheel";
        add_yaw(motion, [&](double, double v) {
          const double rate = turn * beyond * v / robot.half_track_m;
          return std::clamp(rate, -std::min(robot.yaw_rate, robot.lateral / std::max(v, 1e-9)),
                            std::min(robot.yaw_rate, robot.lateral / std::max(v, 1e-9)));
        });
        keep_limits(robot, motion);
        motions.push_back(motion);
      }
    }
  return motions;
}

}  // namespace joulepath::path_bound
