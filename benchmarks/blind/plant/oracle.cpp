#include "oracle.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "case.hpp"

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

/// The case with only some of its effects.
void with_effects(const Case& c, const std::vector<std::size_t>& which, Machine& truth, World& world) {
  truth = c.calibrated;
  world = c.plain_world;
  for (std::size_t k : which) apply_effect(c.effects[k], c.nominal, truth, world);
}

Vector simulate(const Case& c, const Machine& truth, const World& world, std::size_t run) {
  return whitened(noise_free_run(truth, c.nominal, world, c.runs[run], kSmooth), c.noise);
}

/// Effects first (one direction each), then the calibration nuisances; the run's own scatter is marginalized.
Matrix run_information(const Case& c, std::size_t run) {
  std::vector<std::size_t> all;
  for (std::size_t k = 0; k < c.effects.size(); ++k) all.push_back(k);
  const Vector full = simulate(c, c.truth, c.world, run);
  const Vector plain = simulate(c, c.calibrated, c.plain_world, run);
  std::vector<Vector> directions{difference(full, plain, 1.0)};
  if (c.effects.size() > 1)
    for (std::size_t k : all) {
      std::vector<std::size_t> others = all;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
      Machine truth;
      World world;
      with_effects(c, others, truth, world);
      directions.push_back(difference(full, simulate(c, truth, world, run), 1.0));
    }
  constexpr double kStep = 0.5;
  const std::size_t first = directions.size();
  for (int k = 0; k < kNuisances; ++k)
    directions.push_back(
        difference(simulate(c, with_nuisance(c.calibrated, k, kStep), c.plain_world, run), plain, 1 / kStep));
  std::size_t scatter = 0;
  if (c.friction_scatter > 0) {
    const Uncertainty u;
    const double friction = c.friction_scatter / u.friction_torque;
    const Vector zero(plain.size(), 0.0);
    directions.push_back(difference(directions[first], zero, friction));
    directions.push_back(difference(directions[first + 1], zero, friction));
    Machine left = c.calibrated;
    left.resistance_ohm[kLeft] *= 1 + c.resistance_scatter;
    directions.push_back(difference(simulate(c, left, c.plain_world, run), plain, 1.0));
    Machine right = c.calibrated;
    right.resistance_ohm[kRight] *= 1 + c.resistance_scatter;
    directions.push_back(difference(simulate(c, right, c.plain_world, run), plain, 1.0));
    scatter = 4;
  }
  return marginalized(gram_of(directions), scatter, 1.0);
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

/// Where the nominal model misses the true power, run by run, and how much energy that is.
void localize(const Case& c, OracleResult& result) {
  double missed_J = 0, total_J = 0;
  std::map<std::string, std::map<std::string, double>>& where = result.where;
  for (std::size_t run = 0; run < c.runs.size(); ++run) {
    const auto truth = noise_free_run(c.truth, c.nominal, c.world, c.runs[run], kSmooth);
    const auto nominal = noise_free_run(c.nominal, c.nominal, World{}, c.runs[run], kSmooth);
    double run_gap_J = 0, run_J = 0;
    for (std::size_t k = 0; k < truth.size(); ++k)
      for (std::size_t side = 0; side < 2; ++side) {
        const auto power = [side](const Sample& s) {
          return s.motor_voltage_V[side] * s.motor_current_A[side];
        };
        const double gap_J = (power(nominal[k]) - power(truth[k])) * kSamplePeriod_s;
        run_gap_J += gap_J;
        run_J += power(truth[k]) * kSamplePeriod_s;
        where["phase"][phase_of(c.runs[run], k)] += std::abs(gap_J);
        where["wheel"][side == kLeft ? "left" : "right"] += std::abs(gap_J);
      }
    missed_J += std::abs(run_gap_J);
    total_J += std::abs(run_J);
  }
  for (auto& [axis, cells] : where) {
    double sum = 0;
    for (const auto& [cell, joules] : cells) sum += joules;
    for (auto& [cell, joules] : cells) joules /= std::max(sum, 1e-12);
  }
  result.energy_gap_percent = 100 * missed_J / std::max(total_J, 1e-12);
}

}  // namespace

OracleResult consult_oracle(const Case& c) {
  OracleResult result;
  localize(c, result);
  if (c.effects.empty()) return result;
  Matrix sum;
  for (std::size_t run = 0; run < c.runs.size(); ++run) {
    const Matrix information = run_information(c, run);
    if (sum.empty()) sum = Matrix(information.size(), Vector(information.size()));
    for (std::size_t i = 0; i < sum.size(); ++i)
      for (std::size_t j = 0; j < sum.size(); ++j) sum[i][j] += information[i][j];
  }
  const Matrix profiled = marginalized(sum, kNuisances, 1.0);
  result.likelihood_ratio = profiled[0][0];
  if (c.effects.size() == 1) {
    result.each[c.effects[0].name] = profiled[0][0];
    return result;
  }
  for (std::size_t k = 0; k < c.effects.size(); ++k) {  // this effect, the other one profiled without a prior
    const std::size_t other = 2 - k;                    // rows: joint, first, second
    const double own = profiled[k + 1][k + 1], cross = profiled[k + 1][other], rest = profiled[other][other];
    result.each[c.effects[k].name] = own - (rest > 1e-12 ? cross * cross / rest : 0.0);
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
