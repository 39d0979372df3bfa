#include "model/estimate.hpp"

#include <algorithm>
#include <cmath>

#include "model/config_error.hpp"
#include "model/local_fit.hpp"
#include "model/nuisance.hpp"

namespace joulepath {
namespace {

/// A node of the quadrature over time.
struct Node {
  double time_s{};
  double weight_s{};
  BodyMotion<double> motion{};
  Pose pose{};
  double payload_kg{};
};

struct Speeds {
  std::vector<double> speed_m_s{};
  std::vector<double> yaw_rate_rad_s{};
};

[[noreturn]] void refuse(const std::string& key, const std::string& found, const std::string& accepted) {
  throw ConfigError({.mark = {}, .key = key, .found = found, .accepted = accepted, .hint = {}});
}

Speeds speeds_of(const Geometry& geometry, const Trajectory& log) {
  const std::size_t size = log.size();
  if (size < 2) refuse("time_s", std::to_string(size) + " samples", "at least 2");
  if (log.wheel_speed_rad_s.left.size() == size && log.wheel_speed_rad_s.right.size() == size) {
    Speeds speeds;
    for (std::size_t i = 0; i < size; ++i) {
      const Twist<double> twist =
          body_twist(geometry, Sided<double>{log.wheel_speed_rad_s.left[i], log.wheel_speed_rad_s.right[i]});
      speeds.speed_m_s.push_back(twist.speed_m_s);
      speeds.yaw_rate_rad_s.push_back(twist.yaw_rate_rad_s);
    }
    return speeds;
  }
  if (log.linear_speed_m_s.size() != size || log.angular_speed_rad_s.size() != size)
    refuse("wheel_speed_left_rad_s", "nothing", "wheel speeds, or linear and angular speed");
  return {log.linear_speed_m_s, log.angular_speed_rad_s};
}

double at(const std::vector<double>& channel, std::size_t i, double otherwise = 0.0) {
  return channel.empty() ? otherwise : channel[i];
}

/// Speeds linear between the samples: three Gauss points in every interval.
std::vector<Node> nodes_between(const Trajectory& log, const Speeds& speeds, double payload_kg) {
  constexpr double kPlace = 0.7745966692414834;
  constexpr struct {
    double place, weight;
  } kGauss[] = {{-kPlace, 5.0 / 18}, {0.0, 8.0 / 18}, {kPlace, 5.0 / 18}};
  std::vector<Node> nodes;
  for (std::size_t i = 0; i + 1 < log.size(); ++i) {
    const double length_s = log.time_s[i + 1] - log.time_s[i];
    const double dv = speeds.speed_m_s[i + 1] - speeds.speed_m_s[i];
    const double dw = speeds.yaw_rate_rad_s[i + 1] - speeds.yaw_rate_rad_s[i];
    for (const auto& gauss : kGauss) {
      const double u = 0.5 * (1 + gauss.place);
      const auto mix = [&](const std::vector<double>& channel) {
        return channel.empty() ? 0.0 : channel[i] + u * (channel[i + 1] - channel[i]);
      };
      nodes.push_back({.time_s = log.time_s[i] + u * length_s,
                       .weight_s = gauss.weight * length_s,
                       .motion = {speeds.speed_m_s[i] + u * dv, dv / length_s,
                                  speeds.yaw_rate_rad_s[i] + u * dw, dw / length_s},
                       .pose = {mix(log.position_x_m), mix(log.position_y_m), mix(log.heading_rad)},
                       .payload_kg = at(log.payload_kg, i, payload_kg)});
    }
  }
  return nodes;
}

/// Smoothed speeds and their slopes at the samples, trapezoidal weights.
std::vector<Node> nodes_at_samples(const Trajectory& log, const Speeds& speeds, double reach_s,
                                   double payload_kg) {
  const LocalFit v = fit_locally(log.time_s, speeds.speed_m_s, reach_s);
  const LocalFit w = fit_locally(log.time_s, speeds.yaw_rate_rad_s, reach_s);
  std::vector<Node> nodes;
  for (std::size_t i = 0; i < log.size(); ++i) {
    const double before_s = i > 0 ? log.time_s[i] - log.time_s[i - 1] : 0.0;
    const double after_s = i + 1 < log.size() ? log.time_s[i + 1] - log.time_s[i] : 0.0;
    nodes.push_back({.time_s = log.time_s[i],
                     .weight_s = 0.5 * (before_s + after_s),
                     .motion = {v.value[i], v.slope[i], w.value[i], w.slope[i]},
                     .pose = {at(log.position_x_m, i), at(log.position_y_m, i), at(log.heading_rad, i)},
                     .payload_kg = at(log.payload_kg, i, payload_kg)});
  }
  return nodes;
}

/// Speed (rad/s) below which a wheel counts as standing.
double standing_speed_rad_s(const Geometry& geometry, const Speeds& speeds) {
  constexpr double kLeast_rad_s = 1e-6;
  const Sided<double> noise =
      wheel_speeds_rad_s(geometry, noise_of(speeds.speed_m_s), noise_of(speeds.yaw_rate_rad_s));
  return std::max(kLeast_rad_s, 2.0 * std::max(std::abs(noise.left), std::abs(noise.right)));
}

bool stands(const Geometry& geometry, const BodyMotion<double>& motion, double standing_rad_s) {
  const Sided<double> wheels = wheel_speeds_rad_s(geometry, motion.speed_m_s, motion.yaw_rate_rad_s);
  return std::abs(wheels.left) < standing_rad_s && std::abs(wheels.right) < standing_rad_s;
}

Site site_of_node(const Plant& plant, const Node& node, double standing_rad_s, double time_of_day_s) {
  const Geometry& geometry = plant.robot.geometry;
  const BodyMotion<double>& motion = node.motion;
  const Sided<double> wheels = wheel_speeds_rad_s(geometry, motion.speed_m_s, motion.yaw_rate_rad_s);
  Site site =
      site_of(geometry, node.pose, node.payload_kg, motion.speed_m_s, motion.yaw_rate_rad_s, time_of_day_s);
  for (Side side : kSides)
    if (std::abs(wheels[side]) < standing_rad_s) site.wheel_direction[side] = 0;
  if (std::abs(geometry.half_track_m * motion.yaw_rate_rad_s) <
      standing_rad_s * std::min(geometry.wheel_radius_m.left, geometry.wheel_radius_m.right))
    site.turn_direction = 0;
  return site;
}

double counted(double power_W, double efficiency) { return power_W >= 0 ? power_W : efficiency * power_W; }

void add(const Node& node, const Sided<WheelState<double>>& wheels, const PowerByCause& watts,
         const Plant& plant, EnergyEstimate& estimate) {
  Trajectory& power = estimate.power;
  power.time_s.push_back(node.time_s);
  for (Side side : kSides) {
    power.wheel_speed_rad_s[side].push_back(wheels[side].speed_rad_s);
    power.wheel_torque_Nm[side].push_back(wheels[side].torque_Nm);
    power.motor_current_A[side].push_back(wheels[side].current_A);
    power.motor_voltage_V[side].push_back(wheels[side].voltage_V);
    power.motor_power_W[side].push_back(wheels[side].power_W);
    estimate.motor_J[side] += wheels[side].power_W * node.weight_s;
    estimate.counted_J[side] +=
        counted(wheels[side].power_W, plant.robot.power.regeneration_efficiency) * node.weight_s;
  }
  power.battery_power_W.push_back(watts.total_W());
  estimate.by_cause.add(plant, watts, node.weight_s);
  estimate.battery_loss_J += battery_load(plant.robot.battery, watts.total_W()).loss_W * node.weight_s;
  estimate.distance_m += std::abs(node.motion.speed_m_s) * node.weight_s;
}

}  // namespace

EnergyEstimate estimate_energy(const Plant& plant, const Trajectory& log, const EstimateOptions& options) {
  const Speeds speeds = speeds_of(plant.robot.geometry, log);
  const double standing_rad_s = standing_speed_rad_s(plant.robot.geometry, speeds);
  constexpr double kNoNoise_rad_s = 1e-5;
  EnergyEstimate estimate;
  estimate.reach_s = options.reach_s.value_or(standing_rad_s > 2 * kNoNoise_rad_s ? kDefaultReach_s : 0.0);
  const std::vector<Node> nodes = estimate.reach_s > 0
                                      ? nodes_at_samples(log, speeds, estimate.reach_s, options.payload_kg)
                                      : nodes_between(log, speeds, options.payload_kg);
  EffectMemory memory{};
  for (const Node& node : nodes) {
    const double hour_s = options.time_of_day_s + node.time_s - log.time_s.front();
    PowerByCause watts{.standby_W = plant.robot.power.standby_W,
                       .effect_W = std::vector<double>(plant.effects.size(), 0.0)};
    Sided<WheelState<double>> wheels{};
    if (!stands(plant.robot.geometry, node.motion, standing_rad_s)) {
      Site site = site_of_node(plant, node, standing_rad_s, hour_s);
      const double half_m =
          std::hypot(node.motion.speed_m_s, plant.robot.geometry.half_track_m * node.motion.yaw_rate_rad_s) *
          node.weight_s / 2;
      advance_memory(plant, half_m, site.course, memory);
      site.memory = memory;
      wheels = operating_point(plant, node.motion, site);
      watts = power_by_cause(plant, node.motion, site);
      advance_memory(plant, half_m, site.course, memory);
    }
    add(node, wheels, watts, plant, estimate);
  }
  estimate.duration_s = log.time_s.back() - log.time_s.front();
  return estimate;
}

std::optional<Sided<double>> measured_motor_energy_J(const Trajectory& log, double efficiency) {
  const std::size_t size = log.size();
  Sided<double> energy_J{};
  for (Side side : kSides) {
    const bool has_power = log.motor_power_W[side].size() == size && size > 0;
    const bool has_both =
        log.motor_voltage_V[side].size() == size && log.motor_current_A[side].size() == size && size > 0;
    if (!has_power && !has_both) return std::nullopt;
    for (std::size_t i = 0; i + 1 < size; ++i) {
      const auto power_W = [&](std::size_t k) {
        return counted(has_power ? log.motor_power_W[side][k]
                                 : log.motor_voltage_V[side][k] * log.motor_current_A[side][k],
                       efficiency);
      };
      energy_J[side] += 0.5 * (power_W(i) + power_W(i + 1)) * (log.time_s[i + 1] - log.time_s[i]);
    }
  }
  return energy_J;
}

std::optional<double> measured_battery_energy_J(const Trajectory& log) {
  const std::size_t size = log.size();
  if (size == 0 || log.battery_voltage_V.size() != size || log.battery_current_A.size() != size)
    return std::nullopt;
  double energy_J = 0;
  for (std::size_t i = 0; i + 1 < size; ++i)
    energy_J += 0.5 *
                (log.battery_voltage_V[i] * log.battery_current_A[i] +
                 log.battery_voltage_V[i + 1] * log.battery_current_A[i + 1]) *
                (log.time_s[i + 1] - log.time_s[i]);
  return energy_J;
}

double energy_sigma_J(const Robot& robot, const Trajectory& log, const EstimateOptions& options) {
  const auto energy_J = [&](const Nuisance& nuisance, double fraction) {
    Robot other = robot;
    apply_nuisance(nuisance, fraction, other);
    Plant plant = make_plant(other);
    if (is_payload_nuisance(nuisance)) plant.payload_factor *= 1 + fraction;
    const EnergyEstimate estimate = estimate_energy(plant, log, options);
    return estimate.by_cause.total_J() + estimate.battery_loss_J;
  };
  double variance_J2 = 0;
  for (const Nuisance& nuisance : nuisances_of(robot)) {
    const double half_J = (energy_J(nuisance, nuisance.sigma) - energy_J(nuisance, -nuisance.sigma)) / 2;
    variance_J2 += half_J * half_J;
  }
  return std::sqrt(variance_J2);
}

}  // namespace joulepath
