#include "model/estimate.hpp"

#include <algorithm>
#include <cmath>

#include "model/config_error.hpp"
#include "model/local_fit.hpp"
#include "model/nuisance_correlation.hpp"
#include "model/sampled_motion.hpp"

namespace joulepath {
namespace {

[[noreturn]] void refuse(const std::string& key, const std::string& found, const std::string& accepted) {
  throw ConfigError({.mark = {}, .key = key, .found = found, .accepted = accepted, .hint = {}});
}

/// The log's motion with body speeds in every sample, computed from wheel speeds if the log has them.
Trajectory body_motion_of(const Geometry& geometry, const Trajectory& log) {
  const std::size_t size = log.size();
  if (size < 2) refuse("time_s", std::to_string(size) + " samples", "at least 2");
  Trajectory motion;
  motion.time_s = log.time_s;
  motion.position_x_m = log.position_x_m;
  motion.position_y_m = log.position_y_m;
  motion.heading_rad = log.heading_rad;
  motion.payload_kg = log.payload_kg;
  if (log.wheel_speed_rad_s.left.size() == size && log.wheel_speed_rad_s.right.size() == size) {
    for (std::size_t i = 0; i < size; ++i) {
      const Twist<double> twist =
          body_twist(geometry, Sided<double>{log.wheel_speed_rad_s.left[i], log.wheel_speed_rad_s.right[i]});
      motion.linear_speed_m_s.push_back(twist.speed_m_s);
      motion.angular_speed_rad_s.push_back(twist.yaw_rate_rad_s);
    }
    return motion;
  }
  if (log.linear_speed_m_s.size() != size || log.angular_speed_rad_s.size() != size)
    refuse("wheel_speed_left_rad_s", "nothing", "wheel speeds, or linear and angular speed");
  motion.linear_speed_m_s = log.linear_speed_m_s;
  motion.angular_speed_rad_s = log.angular_speed_rad_s;
  return motion;
}

double at(const std::vector<double>& channel, std::size_t i, double otherwise = 0.0) {
  return channel.empty() ? otherwise : channel[i];
}

/// Speed (rad/s) below which a wheel counts as standing.
double standing_speed_rad_s(const Geometry& geometry, const Trajectory& motion) {
  constexpr double kLeast_rad_s = 1e-6;
  const Sided<double> noise =
      wheel_speeds_rad_s(geometry, noise_of(motion.linear_speed_m_s), noise_of(motion.angular_speed_rad_s));
  return std::max(kLeast_rad_s, 2.0 * std::max(std::abs(noise.left), noise.right));
}

void append_power(const Plant& plant, const EnergyNode& node, Trajectory& power) {
  power.time_s.push_back(node.time_s);
  for (Side side : kSides) {
    power.wheel_speed_rad_s[side].push_back(node.wheels[side].speed_rad_s);
    power.wheel_torque_Nm[side].push_back(node.wheels[side].torque_Nm);
    power.motor_current_A[side].push_back(node.wheels[side].current_A);
    power.motor_voltage_V[side].push_back(node.wheels[side].voltage_V);
    power.motor_power_W[side].push_back(node.wheels[side].power_W);
  }
  power.battery_power_W.push_back(drive_power_W(plant, node) + plant.robot.power.standby_W);
}

/// Speeds linear between the samples: the energy integral, and power at three places of every interval.
EnergySum sum_between(const Plant& plant, const Trajectory& motion, const SampledStart& start,
                      Trajectory& power) {
  const SampledMotion sampled(plant, motion, start);
  EnergySum sum(plant);
  sampled.integrate_between(motion.time_s.front(), motion.time_s.back(),
                            [&](const EnergyNode& node) { sum.add(node); });
  for (std::size_t i = 0; i + 1 < motion.size(); ++i)
    for (const double place : kGaussPlaces) {
      const double time_s = motion.time_s[i] + place * (motion.time_s[i + 1] - motion.time_s[i]);
      append_power(plant, energy_node(plant, sampled.at(time_s), time_s), power);
    }
  return sum;
}

/// The energy with noisy speeds, smoothed at the samples together with their slopes: trapezoidal weights.
EnergySum sum_at_samples(const Plant& plant, const Trajectory& log, const SampledStart& start, double reach_s,
                         Trajectory& power) {
  const Geometry& geometry = plant.robot.geometry;
  const LocalFit v = fit_locally(log.time_s, log.linear_speed_m_s, reach_s);
  const LocalFit w = fit_locally(log.time_s, log.angular_speed_rad_s, reach_s);
  EffectMemory memory = start.memory;
  EnergySum sum(plant);
  for (std::size_t i = 0; i < log.size(); ++i) {
    const double before_s = i > 0 ? log.time_s[i] - log.time_s[i - 1] : 0.0;
    const double after_s = i + 1 < log.size() ? log.time_s[i + 1] - log.time_s[i] : 0.0;
    const double weight_s = 0.5 * (before_s + after_s);
    MotionInstant here{.motion = {v.value[i], v.slope[i], w.value[i], w.slope[i]}};
    here.site = site_of(geometry, {at(log.position_x_m, i), at(log.position_y_m, i), at(log.heading_rad, i)},
                        at(log.payload_kg, i, start.payload_kg), v.value[i], w.value[i],
                        start.time_of_day_s + log.time_s[i] - log.time_s.front());
    here.stands = clear_standing(geometry, here.motion, start.standing_rad_s, here.site);
    const double half_m =
        here.stands ? 0.0 : caster_speed_m_s(geometry, v.value[i], w.value[i]) * weight_s / 2;
    advance_memory(plant, half_m, here.site.course, memory);
    here.site.memory = memory;
    const EnergyNode node = energy_node(plant, here, log.time_s[i], weight_s);
    sum.add(node);
    append_power(plant, node, power);
    advance_memory(plant, half_m, here.site.course, memory);
  }
  return sum;
}

}  // namespace

EnergyEstimate estimate_energy(const Plant& plant, const Trajectory& log, const EstimateOptions& options) {
  const Trajectory motion = body_motion_of(plant.robot.geometry, log);
  const SampledStart start{.time_of_day_s = options.time_of_day_s,
                           .payload_kg = options.payload_kg,
                           .standing_rad_s = standing_speed_rad_s(plant.robot.geometry, motion)};
  constexpr double kNoNoise_rad_s = 1e-5;
  EnergyEstimate estimate;
  estimate.reach_s =
      options.reach_s.value_or(start.standing_rad_s > 2 * kNoNoise_rad_s ? kDefaultReach_s : 0.0);
  const EnergySum sum = estimate.reach_s > 0
                            ? sum_at_samples(plant, motion, start, estimate.reach_s, estimate.power)
                            : sum_between(plant, motion, start, estimate.power);
  estimate.motor_J = sum.motor_J();
  estimate.counted_J = sum.counted_J();
  estimate.by_cause = sum.by_cause();
  estimate.battery_loss_J = sum.battery_loss_J();
  estimate.distance_m = sum.distance_m();
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
        return counted_power_W(has_power ? log.motor_power_W[side][k]
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
  const double model_J = robot.model_energy_sigma().value_or(0) *
                         estimate_energy(make_plant(robot), log, options).by_cause.motion_J();
  double variance_J2 = model_J * model_J;
  std::vector<double> shifts_J;
  for (const Nuisance& nuisance : nuisances_of(robot)) {
    const double half_J = (energy_J(nuisance, nuisance.sigma) - energy_J(nuisance, -nuisance.sigma)) / 2;
    variance_J2 += half_J * half_J;
    shifts_J.push_back(half_J);
  }
  return std::sqrt(std::max(0.0, variance_J2 + correlated_variance(shifts_J, nuisance_correlation(robot))));
}

}  // namespace joulepath
