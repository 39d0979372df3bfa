#include "oracle.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "observer.hpp"
#include "signals.hpp"
// Design: docs/decisions/0802-blind-benchmark.md
namespace blind {
namespace {

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

using Logs = std::vector<std::vector<Sample>>;

Logs driven(const Case& c, const Machine& machine, const World& world) {
  Logs logs;
  for (const Run& run : c.runs) logs.push_back(noise_free_run(machine, c.nominal, world, run, kSmooth));
  return logs;
}

double motor_power_W(const Sample& s, std::size_t side) {
  return s.motor_voltage_V[side] * s.motor_current_A[side];
}

/// What changes between the logs without and with an effect, as shares of those with all effects.
Change change_between(const Logs& without, const Logs& with) {
  double changed_J = 0, total_J = 0, battery_changed_J = 0, battery_J = 0, pose = 0, samples = 0;
  for (std::size_t run = 0; run < with.size(); ++run) {
    double motors_J = 0, motors_before_J = 0, drawn_J = 0, drawn_before_J = 0;
    for (std::size_t k = 0; k < with[run].size(); ++k) {
      const Sample &now = with[run][k], &before = without[run][k];
      for (std::size_t side = 0; side < 2; ++side) {
        motors_J += motor_power_W(now, side) * kSamplePeriod_s;
        motors_before_J += motor_power_W(before, side) * kSamplePeriod_s;
      }
      drawn_J += now.battery_voltage_V * now.battery_current_A * kSamplePeriod_s;
      drawn_before_J += before.battery_voltage_V * before.battery_current_A * kSamplePeriod_s;
      pose += std::pow(now.x_m - before.x_m, 2) + std::pow(now.y_m - before.y_m, 2) +
              std::pow(now.heading_rad - before.heading_rad, 2);
      samples += 1;
    }
    changed_J += std::abs(motors_J - motors_before_J);
    total_J += std::abs(motors_J);
    battery_changed_J += std::abs(drawn_J - drawn_before_J);
    battery_J += drawn_J;
  }
  const double battery_percent = 100 * battery_changed_J / battery_J;
  return {battery_percent, std::max(100 * changed_J / std::max(total_J, 1e-12), battery_percent),
          std::sqrt(pose / samples)};
}

/// The difference between the nominal and the true power, run by run, and its energy.
void localize(const Case& c, const Logs& truth, OracleResult& result) {
  const Logs nominal = driven(c, c.nominal, World{});
  double missed_J = 0, total_J = 0;
  std::map<std::string, std::map<std::string, double>>& where = result.where;
  for (std::size_t run = 0; run < c.runs.size(); ++run) {
    double run_gap_J = 0, run_J = 0;
    for (std::size_t k = 0; k < truth[run].size(); ++k)
      for (std::size_t side = 0; side < 2; ++side) {
        const double power_W = motor_power_W(truth[run][k], side);
        const double gap_J = (motor_power_W(nominal[run][k], side) - power_W) * kSamplePeriod_s;
        run_gap_J += gap_J;
        run_J += power_W * kSamplePeriod_s;
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

OracleResult consult_oracle(const Case& c, bool with_observer) {
  OracleResult result;
  const Logs truth = driven(c, c.truth, c.world);
  localize(c, truth, result);
  result.change = change_between(driven(c, c.calibrated, c.plain_world), truth);
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
    if (with_observer && !c.effects[0].foreign && result.likelihood_ratio >= kDetectable)
      result.separation = separation_of(c, full, directions, result.likelihood_ratio);
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
    result.each_change[c.effects[k].name] = change_between(driven(c, other.machine, other.world), truth);
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
  const auto change = [](const Change& moved) {
    std::ostringstream out;
    out << "\"battery_percent\": " << moved.battery_percent
        << ", \"effect_percent\": " << moved.effect_percent << ", \"effect_pose_rms\": " << moved.pose_rms;
    return out.str();
  };
  std::ostringstream out;
  out << "{\"likelihood_ratio\": " << r.likelihood_ratio << ", \"detectable\": " << (all ? "true" : "false")
      << ", " << change(r.change) << ", \"energy_gap_percent\": " << r.energy_gap_percent
      << ", \"each\": " << object(r.each) << ", \"each_change\": {";
  const char* next = "";
  for (const auto& [name, moved] : r.each_change) {
    out << next << "\"" << name << "\": {" << change(moved) << "}";
    next = ", ";
  }
  out << "}";
  if (r.separation)
    out << ", \"separation\": " << r.separation->ratio
        << ", \"separable\": " << (r.separation->ratio >= kDetectable ? "true" : "false")
        << ", \"single_separation\": " << r.separation->single_ratio << ", \"best_rival\": \""
        << r.separation->rival << "\"";
  out << ", \"where\": {";
  const char* comma = "";
  for (const auto& [axis, cells] : r.where) {
    out << comma << "\"" << axis << "\": " << object(cells);
    comma = ", ";
  }
  out << "}}";
  return out.str();
}

}  // namespace blind
