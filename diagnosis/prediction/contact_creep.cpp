#include "diagnosis/prediction/contact_creep.hpp"

#include <cmath>

#include "model/kinematics.hpp"

// Design: docs/decisions/0501-motion.md
namespace joulepath {
namespace {

/// Central differences.
Eigen::VectorXd slopes(const Eigen::VectorXd& y, double period_s) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(y.size());
  for (Eigen::Index j = 1; j + 1 < y.size(); ++j) result[j] = (y[j + 1] - y[j - 1]) / (2 * period_s);
  return result;
}

/// Creep and its rate in one direction. What follows the acceleration has its slope from the jerk, for which
/// the samples are too rare.
Lagged follow(const Eigen::VectorXd& at_once, const Eigen::VectorXd& lag_s,
              const Eigen::VectorXd& acceleration, const Eigen::VectorXd& jerk, double period_s) {
  const Eigen::VectorXd rest = at_once - lag_s.cwiseProduct(acceleration);
  return lagged(at_once, slopes(rest, period_s) + lag_s.cwiseProduct(jerk), lag_s, period_s);
}

}  // namespace

Lagged lagged(const Eigen::VectorXd& target, const Eigen::VectorXd& slope, const Eigen::VectorXd& lag_s,
              double period_s) {
  Lagged y{target, slope};
  for (Eigen::Index j = 1; j < target.size(); ++j) {
    const double lag = lag_s[j], bend = (slope[j] - slope[j - 1]) / period_s;
    if (!(lag > 0)) continue;
    // A parabola p has the solution p - lag (p' - lag p"); what is left at the start decays.
    const double left = y.value[j - 1] - (target[j - 1] - lag * (slope[j - 1] - lag * bend));
    const double decayed = left * std::exp(-period_s / lag);
    y.value[j] = target[j] - lag * (slope[j] - lag * bend) + decayed;
    y.rate[j] = slope[j] - lag * bend - decayed / lag;
  }
  return y;
}

BodyLag contact_creep(const Plant& plant, const RunSignals& signals,
                      const std::vector<Sided<double>>& contact_force_N) {
  const double c = 0.5 * plant.creep_m_s_N, half_track_m = plant.robot.geometry.half_track_m;
  const Eigen::Index n = signals.size();
  Eigen::VectorXd along(n), turn(n), along_lag_s(n), turn_lag_s(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto [left_N, right_N] = contact_force_N[static_cast<std::size_t>(j)];
    const MassProperties mass = mass_properties(plant.robot, plant.payload_kg(signals.payload_kg[j]));
    along[j] = c * (left_N + right_N);
    turn[j] = c * (right_N - left_N) / half_track_m;
    along_lag_s[j] = c * mass.mass_kg;
    turn_lag_s[j] = c * mass.yaw_inertia_kg_m2 / (half_track_m * half_track_m);
  }
  Sided<Eigen::VectorXd> wheel_jerk = signals.wheel_jerk_rad_s3;
  if (wheel_jerk.left.size() != n) wheel_jerk.left = wheel_jerk.right = Eigen::VectorXd::Zero(n);
  const Twist<Eigen::VectorXd> rate = body_twist(plant.robot.geometry, signals.wheel_acceleration_rad_s2),
                               jerk = body_twist(plant.robot.geometry, wheel_jerk);
  return {.along = follow(along, along_lag_s, rate.speed_m_s, jerk.speed_m_s, signals.period_s),
          .turn = follow(turn, turn_lag_s, rate.yaw_rate_rad_s, jerk.yaw_rate_rad_s, signals.period_s)};
}

}  // namespace joulepath
