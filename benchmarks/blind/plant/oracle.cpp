#include "oracle.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "case.hpp"
// Design: docs/decisions/0032-blind-detectable.md
namespace blind {
namespace {

using Vector = std::vector<double>;
using Matrix = std::vector<Vector>;

constexpr Discretization kSmooth{1e-3, false};

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

Vector difference(const Vector& a, const Vector& b, double scale) {
  Vector out(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) out[k] = scale * (a[k] - b[k]);
  return out;
}

/// Marginalize the last `count` directions of a Gram matrix (unit prior each, or none): Schur complement,
/// one direction after the other.
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
  Matrix gram(directions.size(), Vector(directions.size()));
  for (std::size_t i = 0; i < directions.size(); ++i)
    for (std::size_t j = i; j < directions.size(); ++j) {
      double sum = 0;
      for (std::size_t k = 0; k < directions[i].size(); ++k) sum += directions[i][k] * directions[j][k];
      gram[i][j] = gram[j][i] = sum;
    }
  return gram;
}

/// Machine and world of the case with some of its effects.
struct Scene {
  Machine machine{};
  World world{};
};

Scene scene_with(const Case& c, const std::vector<std::size_t>& which) {
  Scene scene{c.calibrated, c.plain_world};
  for (std::size_t k : which) apply_effect(c.effects[k], c.nominal, scene.machine, scene.world);
  return scene;
}

Vector simulate(const Case& c, const Scene& scene, std::size_t run) {
  return whitened(noise_free_run(scene.machine, c.nominal, scene.world, c.runs[run], kSmooth), c.noise);
}

Scene shifted(Scene scene, const Vector& sigmas) {
  for (int k = 0; k < kNuisances; ++k)
    scene.machine = with_nuisance(scene.machine, k, sigmas[static_cast<std::size_t>(k)]);
  return scene;
}

/// One run's directions in whitened signals: calibration nuisances, free directions, the run's own scatter.
struct RunDirections {
  std::vector<Vector> nuisance, scatter;
};

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

/// min over calibration errors nu of |full - null(nu)|^2 + |nu|^2, by Gauss-Newton. Each step simulates the
/// null model again, because a calibration error that accumulates in the pose is not evidence. `free` has a
/// direction per run without a cost (another effect's size), or is empty.
double profiled_ratio(const Case& c, const Scene& null, const std::vector<Vector>& full,
                      const std::vector<RunDirections>& directions, const std::vector<Vector>& free) {
  Vector nu(kNuisances, 0.0);
  double value = 0;
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    Matrix sum;
    for (std::size_t run = 0; run < c.runs.size(); ++run) {
      std::vector<Vector> columns{difference(full[run], simulate(c, shifted(null, nu), run), 1.0)};
      columns.insert(columns.end(), directions[run].nuisance.begin(), directions[run].nuisance.end());
      if (!free.empty()) columns.push_back(free[run]);
      columns.insert(columns.end(), directions[run].scatter.begin(), directions[run].scatter.end());
      const Matrix gram = marginalized(gram_of(columns), directions[run].scatter.size(), 1.0);
      if (sum.empty()) sum = Matrix(gram.size(), Vector(gram.size()));
      for (std::size_t i = 0; i < sum.size(); ++i)
        for (std::size_t j = 0; j < sum.size(); ++j) sum[i][j] += gram[i][j];
    }
    if (!free.empty()) sum = marginalized(sum, 1, 0.0);
    for (std::size_t k = 0; k < kNuisances; ++k) {  // the prior's pull, about nu
      sum[0][0] += nu[k] * nu[k];
      sum[0][k + 1] -= nu[k];
      sum[k + 1][0] -= nu[k];
    }
    const double here = marginalized(sum, kNuisances, 1.0)[0][0];
    if (round > 0 && !(here <= value)) break;  // no step, or a step to an invalid state of the model
    value = here;
    for (std::size_t k = 0; k < kNuisances; ++k) {  // the step of nuisance k: eliminate all others first
      Matrix order = sum;
      std::swap(order[1], order[k + 1]);
      for (Vector& row : order) std::swap(row[1], row[k + 1]);
      const Matrix two = marginalized(order, kNuisances - 1, 1.0);
      nu[k] += two[0][1] / (two[1][1] + 1.0);
    }
  }
  return value;
}

std::string phase_of(const Run& run, std::size_t sample) {
  const std::size_t tick = std::min(2 * sample, run.speed_m_s.size() - 1);
  const std::size_t later = std::min(tick + 2, run.speed_m_s.size() - 1);
  const double v = run.speed_m_s[tick], w = run.yaw_rate_rad_s[tick];
  if (std::abs(v) < 1e-9 && std::abs(w) < 1e-9) return "standstill";
  if (std::abs(v) < 1e-9) return "spin";
  if (std::abs(w) > 0.05) return "turn";
  const double change = std::abs(run.speed_m_s[later]) - std::abs(v);
  return change > 1e-9 ? "accelerate" : (change < -1e-9 ? "brake" : "cruise");
}

/// The difference between the nominal and the true power, run by run, and its energy.
void localize(const Case& c, OracleResult& result) {
  double missed_J = 0, total_J = 0, changed_J = 0, battery_J = 0, battery_changed_J = 0, pose = 0,
         samples = 0;
  std::map<std::string, std::map<std::string, double>>& where = result.where;
  for (std::size_t run = 0; run < c.runs.size(); ++run) {
    const auto truth = noise_free_run(c.truth, c.nominal, c.world, c.runs[run], kSmooth);
    const auto nominal = noise_free_run(c.nominal, c.nominal, World{}, c.runs[run], kSmooth);
    const auto plain = noise_free_run(c.calibrated, c.nominal, c.plain_world, c.runs[run], kSmooth);
    double run_gap_J = 0, run_J = 0, change_J = 0, drawn_J = 0, plain_drawn_J = 0;
    for (std::size_t k = 0; k < truth.size(); ++k)
      for (std::size_t side = 0; side < 2; ++side) {
        const auto power = [side](const Sample& s) {
          return s.motor_voltage_V[side] * s.motor_current_A[side];
        };
        const double gap_J = (power(nominal[k]) - power(truth[k])) * kSamplePeriod_s;
        run_gap_J += gap_J;
        change_J += (power(truth[k]) - power(plain[k])) * kSamplePeriod_s;
        run_J += power(truth[k]) * kSamplePeriod_s;
        where["phase"][phase_of(c.runs[run], k)] += std::abs(gap_J);
        where["wheel"][side == kLeft ? "left" : "right"] += std::abs(gap_J);
      }
    for (std::size_t k = 0; k < truth.size(); ++k) {
      drawn_J += truth[k].battery_voltage_V * truth[k].battery_current_A * kSamplePeriod_s;
      plain_drawn_J += plain[k].battery_voltage_V * plain[k].battery_current_A * kSamplePeriod_s;
      pose += std::pow(truth[k].x_m - plain[k].x_m, 2) + std::pow(truth[k].y_m - plain[k].y_m, 2) +
              std::pow(truth[k].heading_rad - plain[k].heading_rad, 2);
      samples += 1;
    }
    changed_J += std::abs(change_J);
    battery_J += drawn_J;
    battery_changed_J += std::abs(drawn_J - plain_drawn_J);
    missed_J += std::abs(run_gap_J);
    total_J += std::abs(run_J);
  }
  for (auto& [axis, cells] : where) {
    double sum = 0;
    for (const auto& [cell, joules] : cells) sum += joules;
    for (auto& [cell, joules] : cells) joules /= std::max(sum, 1e-12);
  }
  result.battery_percent = 100 * battery_changed_J / battery_J;
  result.effect_percent = std::max(100 * changed_J / std::max(total_J, 1e-12), result.battery_percent);
  result.effect_pose_rms = std::sqrt(pose / samples);
  result.energy_gap_percent = 100 * missed_J / std::max(total_J, 1e-12);
}

}  // namespace

OracleResult consult_oracle(const Case& c) {
  OracleResult result;
  localize(c, result);
  if (c.effects.empty()) return result;
  const Scene plain = scene_with(c, {});
  std::vector<Vector> full;
  std::vector<RunDirections> directions;
  for (std::size_t run = 0; run < c.runs.size(); ++run) {
    full.push_back(simulate(c, {c.truth, c.world}, run));
    directions.push_back(directions_of(c, plain, run));
  }
  result.likelihood_ratio = profiled_ratio(c, plain, full, directions, {});
  if (c.effects.size() == 1) {
    result.each[c.effects[0].name] = result.likelihood_ratio;
    return result;
  }
  for (std::size_t k = 0; k < c.effects.size(); ++k) {  // this effect; the common size of the others is free
    std::vector<std::size_t> others;
    for (std::size_t j = 0; j < c.effects.size(); ++j)
      if (j != k) others.push_back(j);
    const Scene other = scene_with(c, others), own = scene_with(c, {k});
    std::vector<Vector> free;
    for (std::size_t run = 0; run < c.runs.size(); ++run)
      free.push_back(difference(full[run], simulate(c, own, run), 1.0));
    result.each[c.effects[k].name] = profiled_ratio(c, other, full, directions, free);
  }
  return result;
}

std::string oracle_json(const OracleResult& r) {
  const auto object = [](const std::map<std::string, double>& values) {
    std::ostringstream out;
    for (const auto& [key, value] : values)
      out << (out.tellp() > 0 ? ", " : "") << "\"" << key << "\": " << value;
    return "{" + out.str() + "}";
  };
  bool all = !r.each.empty();
  for (const auto& [name, ratio] : r.each) all = all && ratio >= kDetectable;
  std::ostringstream out;
  out << "{\"likelihood_ratio\": " << r.likelihood_ratio << ", \"detectable\": " << (all ? "true" : "false")
      << ", \"battery_percent\": " << r.battery_percent << ", \"effect_percent\": " << r.effect_percent
      << ", \"effect_pose_rms\": " << r.effect_pose_rms
      << ", \"energy_gap_percent\": " << r.energy_gap_percent << ", \"each\": " << object(r.each)
      << ", \"where\": {";
  const char* comma = "";
  for (const auto& [axis, cells] : r.where) {
    out << comma << "\"" << axis << "\": " << object(cells);
    comma = ", ";
  }
  out << "}}";
  return out.str();
}

}  // namespace blind
