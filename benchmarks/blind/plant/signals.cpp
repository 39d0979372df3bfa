#include "signals.hpp"

#include <algorithm>
#include <cmath>

namespace blind {
namespace {

/// All channels of a log divided by their noise, AR(1) channels as innovations: white and of unit variance.
Vector whitened(const std::vector<Sample>& log, const SensorNoise& n) {
  Vector out;
  out.reserve(log.size() * 12);
  const auto channel = [&](auto&& pick, double deviation, double correlation) {
    const double scale = deviation * std::sqrt(1 - correlation * correlation);
    double before = 0;
    for (std::size_t k = 0; k < log.size(); ++k) {
      const double now = pick(log[k]);
      out.push_back(k == 0 ? now / deviation : (now - correlation * before) / scale);
      before = now;
    }
  };
  const double electric = n.electrical_correlation, motion = n.motion_correlation;
  for (std::size_t side = 0; side < 2; ++side) {
    channel([side](const Sample& s) { return s.wheel_speed_rad_s[side]; }, n.wheel_speed_rad_s, motion);
    channel([side](const Sample& s) { return s.motor_voltage_V[side]; }, n.voltage_V, electric);
    channel([side](const Sample& s) { return s.motor_current_A[side]; }, n.current_A, electric);
  }
  channel([](const Sample& s) { return s.battery_voltage_V; }, n.battery_voltage_V, 0);
  channel([](const Sample& s) { return s.battery_current_A; }, n.battery_current_A, 0);
  channel([](const Sample& s) { return s.gyro_rad_s; }, n.gyro_rad_s, motion);
  channel([](const Sample& s) { return s.x_m; }, n.position_m, 0);
  channel([](const Sample& s) { return s.y_m; }, n.position_m, 0);
  channel([](const Sample& s) { return s.heading_rad; }, n.heading_rad, 0);
  return out;
}

}  // namespace

Vector difference(const Vector& a, const Vector& b, double scale) {
  Vector out(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) out[k] = scale * (a[k] - b[k]);
  return out;
}

Matrix marginalized(Matrix gram, std::size_t count, double prior) {
  for (std::size_t step = 0; step < count; ++step) {
    const std::size_t last = gram.size() - 1;
    const double pivot = gram[last][last] + prior;
    if (pivot > 1e-12)
      for (std::size_t i = 0; i < last; ++i)
        for (std::size_t j = 0; j < last; ++j) gram[i][j] -= gram[i][last] * gram[j][last] / pivot;
    gram.pop_back();
    for (Vector& row : gram) row.pop_back();
  }
  return gram;
}

Matrix gram_of(const std::vector<Vector>& directions) {
  const std::size_t count = directions.size();
  Vector sum(count * count), row(count);
  for (std::size_t k = 0; k < directions[0].size(); ++k) {
    for (std::size_t i = 0; i < count; ++i) row[i] = directions[i][k];
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = i; j < count; ++j) sum[i * count + j] += row[i] * row[j];
  }
  Matrix gram(count, Vector(count));
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < count; ++j) gram[i][j] = sum[std::min(i, j) * count + std::max(i, j)];
  return gram;
}

Scene scene_with(const Case& c, const std::vector<std::size_t>& which) {
  Scene scene{c.calibrated, c.plain_world};
  for (std::size_t k : which) apply_effect(c.effects[k], c.nominal, scene.machine, scene.world);
  return scene;
}

Vector simulate(const Case& c, const Scene& scene, std::size_t run, const Discretization& steps) {
  return whitened(noise_free_run(scene.machine, c.nominal, scene.world, c.runs[run], steps), c.noise);
}

Scene shifted(Scene scene, const Vector& sigmas) {
  for (int k = 0; k < kNuisances; ++k)
    scene.machine = with_nuisance(scene.machine, k, sigmas[static_cast<std::size_t>(k)]);
  return scene;
}

RunDirections directions_of(const Case& c, const Scene& scene, std::size_t run) {
  constexpr double kStep = 0.5;
  RunDirections d;
  const Vector plain = simulate(c, scene, run);
  for (int k = 0; k < kNuisances; ++k) {
    Scene moved = scene;
    moved.machine = with_nuisance(moved.machine, k, kStep);
    d.nuisance.push_back(difference(simulate(c, moved, run), plain, 1 / kStep));
  }
  if (c.friction_scatter <= 0) return d;
  const Uncertainty u;
  const Vector zero(plain.size(), 0.0);
  for (std::size_t side = 0; side < 2; ++side) {
    d.scatter.push_back(difference(d.nuisance[side], zero, c.friction_scatter / u.friction_torque));
    Scene moved = scene;
    moved.machine.resistance_ohm[side] *= 1 + c.resistance_scatter;
    d.scatter.push_back(difference(simulate(c, moved, run), plain, 1.0));
  }
  return d;
}

}  // namespace blind
