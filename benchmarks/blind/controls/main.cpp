// blind_controls DATA_SET_FOLDER OUT.json: results of simpler methods on the same data, in the form of
// diagnosis.json. Methods: always friction, a plain refit of the robot file's parameters, sparse regression
// (STLSQ), and a black box on the residual power. Every fourth run is held out for the energy figures.
#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include "library.hpp"
#include "regression.hpp"

namespace {

using namespace control;
using Weights = std::array<double, kChannels>;

struct Fit {
  std::vector<Term> terms;
  std::vector<double> coefficient;
};

struct Energy {
  double before{}, after{}, measured{};
};

bool held_out(std::size_t run) { return run % 4 == 3; }

/// 1/variance per channel from neighbouring residuals: noise, not misfit.
Weights weights_of(const std::vector<std::vector<Row>>& rows) {
  std::array<double, kChannels> sum{}, count{}, last{};
  std::array<bool, kChannels> any{};
  for (const auto& run : rows)
    for (const Row& row : run) {
      const auto c = static_cast<std::size_t>(row.channel);
      const double residual = row.measured - row.nominal;
      if (any[c]) sum[c] += 0.5 * (residual - last[c]) * (residual - last[c]), count[c] += 1;
      last[c] = residual;
      any[c] = true;
    }
  Weights weights{};
  for (std::size_t c = 0; c < kChannels; ++c) weights[c] = sum[c] > 0 ? count[c] / sum[c] : 0.0;
  return weights;
}

Regression gather(const std::vector<std::vector<Row>>& rows, const std::vector<Term>& terms,
                  const Weights& weights, const std::function<bool(std::size_t)>& use) {
  Regression regression(terms.size());
  std::vector<double> values(terms.size());
  for (std::size_t run = 0; run < rows.size(); ++run) {
    if (!use(run)) continue;
    for (const Row& row : rows[run]) {
      for (std::size_t j = 0; j < terms.size(); ++j) values[j] = terms[j].value(row);
      regression.add(values, row.measured - row.nominal, weights[static_cast<std::size_t>(row.channel)]);
    }
  }
  return regression;
}

/// Energies of the held-out runs predicted by the fitted model: V and i from their rows.
Energy held_out_energy(const std::vector<std::vector<Row>>& rows, const Fit& fit) {
  Energy energy;
  for (std::size_t run = 0; run < rows.size(); ++run) {
    if (!held_out(run)) continue;
    double before = 0, after = 0, measured = 0, amps = 0, amps_fitted = 0, amps_measured = 0;
    for (const Row& row : rows[run]) {
      if (row.channel > Channel::voltage_right) continue;
      double more = 0;
      for (std::size_t j = 0; j < fit.terms.size(); ++j)
        if (fit.coefficient[j] != 0) more += fit.coefficient[j] * fit.terms[j].value(row);
      if (row.channel == Channel::current_left || row.channel == Channel::current_right) {
        amps = row.nominal, amps_fitted = row.nominal + more, amps_measured = row.measured;
        continue;  // the voltage row of this wheel follows
      }
      const std::size_t side = row.channel == Channel::voltage_right ? 1 : 0;
      const double emf = row.at.robot->torque_per_ampere() * row.at.q[side], ohm = row.at.robot->ohm;
      before += (ohm * amps + emf) * amps;
      after += (ohm * amps_fitted + emf + more) * amps_fitted;
      measured += row.measured * amps_measured;
    }
    energy.before += std::abs(before - measured);
    energy.after += std::abs(after - measured);
    energy.measured += std::abs(measured);
  }
  return energy;
}

std::string answer(const std::vector<std::pair<std::string, std::string>>& causes, const Energy& e) {
  std::ostringstream out;
  out << "{\"verdict\": \"" << (causes.empty() ? "no_gap" : "explained") << "\", \"causes\": [";
  for (std::size_t k = 0; k < causes.size(); ++k)
    out << (k ? ", " : "") << "{\"effect\": \"" << causes[k].first
        << "\", \"probability\": 1.0, \"parameters\": {" << causes[k].second << "}}";
  const double floor = std::max(e.measured, 1e-9);
  out << "], \"gap\": {\"energy\": {\"before_percent\": " << 100 * e.before / floor
      << ", \"after_percent\": " << 100 * e.after / floor
      << ", \"shrink_fraction\": " << (e.before > 0 ? 1 - e.after / e.before : 0.0) << "}}}";
  return out.str();
}

std::string parameter(const Term& term, double value) {
  std::ostringstream out;
  out << "\"" << term.parameter << "\": {\"value\": " << value << "}";
  if (!term.side.empty()) out << ", \"side\": {\"value\": \"" << term.side << "\"}";
  return out.str();
}

/// The calibration error of a parameter that the robot file's `uncertainty` allows, one sigma in the term's
/// unit; 0 = not listed.
double calibration_sigma(const Term& term, const Robot& robot) {
  const double torque = robot.friction_Nm[term.side == "right" ? 1 : 0];
  const std::map<std::string, double> sigma{{"dragging_wheel", 0.015 * torque},
                                            {"coulomb_friction", 0.015 * torque},
                                            {"viscous_friction", 0.05 * robot.viscous},
                                            {"winding_resistance_error", 0.01},
                                            {"torque_constant_error", 0.005},
                                            {"yaw_inertia_error", 0.04},
                                            {"wheel_radius_error", 0.003},
                                            {"track_width_error", 0.008},
                                            {"payload_mass_error", 0.01},
                                            {"axle_inertia", 0.02}};
  const auto at = sigma.find(term.effect);
  return at == sigma.end() ? 0.0 : at->second;
}

std::string always_friction(const std::vector<std::vector<Row>>& rows, const Robot& robot,
                            const Weights& weights) {
  Fit fit{{effect_library(robot)[0]}, {}};
  fit.coefficient =
      gather(rows, fit.terms, weights, [](std::size_t run) { return !held_out(run); }).solve({true});
  return answer({{"coulomb_friction", parameter(fit.terms[0], fit.coefficient[0])}},
                held_out_energy(rows, fit));
}

/// Least squares on the parameters of the robot file. The result names the parameter that changed by the most
/// sigmas of its calibration.
std::string plain_refit(const std::vector<std::vector<Row>>& rows, const Robot& robot,
                        const Weights& weights) {
  Fit fit{parameter_library(robot), {}};
  const Regression regression =
      gather(rows, fit.terms, weights, [](std::size_t run) { return !held_out(run); });
  fit.coefficient = regression.solve(std::vector<bool>(fit.terms.size(), true));
  std::size_t best = 0;
  double most = 0;
  std::vector<double> moved(fit.terms.size());
  for (std::size_t j = 0; j < fit.terms.size(); ++j) {
    const double s = calibration_sigma(fit.terms[j], robot);
    moved[j] = s > 0 ? fit.coefficient[j] / s : 0.0;
    const double change = std::abs(fit.coefficient[j]) * regression.norm(j);
    if (std::abs(moved[j]) > 3 && change > most) most = change, best = j;
  }
  std::vector<std::pair<std::string, std::string>> causes;
  if (most > 0 && fit.terms[best].effect != "axle_inertia") {
    Term named = fit.terms[best];
    if (named.effect == "dragging_wheel" && moved[0] * moved[1] > 0 &&
        std::min(std::abs(moved[0]), std::abs(moved[1])) > 3)
      named.effect = "coulomb_friction", named.side.clear();  // both wheels moved: friction on both
    causes.emplace_back(named.effect, parameter(named, fit.coefficient[best]));
  }
  return answer(causes, held_out_energy(rows, fit));
}

/// Sequentially thresholded least squares at one threshold (relative to the target's norm).
std::vector<double> thresholded(const Regression& regression, std::size_t columns, double threshold) {
  std::vector<bool> active(columns, true);
  std::vector<double> x;
  for (int round = 0; round < 12; ++round) {
    x = regression.solve(active, 0.05);  // the ridge that damps collinear columns, as in PySINDy's STLSQ
    bool changed = false;
    for (std::size_t j = 0; j < columns; ++j)
      if (active[j] && std::abs(x[j]) * regression.norm(j) < threshold * regression.target_norm())
        active[j] = false, changed = true;
    if (!changed) break;
  }
  return regression.solve(active, 1e-6);
}

/// STLSQ; the threshold is the largest whose error on a third of the training runs is within 1 % of the best.
std::string stlsq(const std::vector<std::vector<Row>>& rows, const Robot& robot, const Weights& weights) {
  Fit fit{effect_library(robot), {}};
  const auto training = [](std::size_t run) { return !held_out(run) && run % 3 != 0; };
  const auto checking = [](std::size_t run) { return !held_out(run) && run % 3 == 0; };
  const Regression train = gather(rows, fit.terms, weights, training),
                   check = gather(rows, fit.terms, weights, checking);
  const std::vector<double> thresholds{0.3, 0.2, 0.14, 0.1, 0.07, 0.05, 0.03, 0.02};
  std::vector<double> error;
  for (double t : thresholds) error.push_back(check.rest(thresholded(train, fit.terms.size(), t)));
  const double best = *std::min_element(error.begin(), error.end());
  if (best > 0.95 * check.rest(std::vector<double>(fit.terms.size(), 0.0))) {  // no name
    fit.coefficient.assign(fit.terms.size(), 0.0);
    return answer({}, held_out_energy(rows, fit));
  }
  double chosen = thresholds.back();
  for (std::size_t k = thresholds.size(); k-- > 0;)
    if (error[k] <= 1.01 * best) chosen = thresholds[k];
  const Regression all = gather(rows, fit.terms, weights, [](std::size_t run) { return !held_out(run); });
  fit.coefficient = thresholded(all, fit.terms.size(), chosen);
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t j = 0; j < fit.terms.size(); ++j)
    if (fit.coefficient[j] != 0 && std::abs(fit.coefficient[j]) > 3 * calibration_sigma(fit.terms[j], robot))
      order.emplace_back(std::abs(fit.coefficient[j]) * all.norm(j), j);
  std::sort(order.rbegin(), order.rend());
  std::vector<std::pair<std::string, std::string>> causes;
  for (const auto& [size, j] : order) {
    const std::string& name = fit.terms[j].effect;
    if (std::none_of(causes.begin(), causes.end(), [&](const auto& c) { return c.first == name; }))
      causes.emplace_back(name, parameter(fit.terms[j], fit.coefficient[j]));
  }
  return answer(causes, held_out_energy(rows, fit));
}

std::vector<double> features(const Row& row, std::size_t side) {
  const Instant& at = row.at;
  const double base[] = {1,    at.q[side], std::abs(at.q[side]), at.dq[side],
                         at.w, at.dw,      0.1 * at.payload_kg,  at.sign(side)};
  std::vector<double> out;
  for (std::size_t i = 0; i < std::size(base); ++i)
    for (std::size_t j = i; j < std::size(base); ++j) out.push_back(base[i] * base[j]);
  return out;
}

/// Ridge regression of each wheel's residual power on all products of two of its motion's variables.
std::string black_box(const std::vector<std::vector<Row>>& rows) {
  const std::size_t columns = features(rows[0][0], 0).size();
  std::array<Regression, 2> fit{Regression(columns), Regression(columns)};
  std::array<std::vector<double>, 2> x;
  Energy energy;
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t run = 0; run < rows.size(); ++run) {
      if (held_out(run) != (pass == 1)) continue;
      double before = 0, after = 0, measured_J = 0, amps = 0, amps_measured = 0;
      for (const Row& row : rows[run]) {
        if (row.channel == Channel::current_left || row.channel == Channel::current_right)
          amps = row.nominal, amps_measured = row.measured;
        if (row.channel != Channel::voltage_left && row.channel != Channel::voltage_right) continue;
        const std::size_t side = row.channel == Channel::voltage_right ? 1 : 0;
        const double nominal =
            (row.at.robot->ohm * amps + row.at.robot->torque_per_ampere() * row.at.q[side]) * amps;
        const double measured = row.measured * amps_measured;
        const std::vector<double> f = features(row, side);
        if (pass == 0) {
          fit[side].add(f, measured - nominal, 1.0);
          continue;
        }
        double more = 0;
        for (std::size_t j = 0; j < columns; ++j) more += x[side][j] * f[j];
        before += nominal, after += nominal + more, measured_J += measured;
      }
      if (pass == 0) continue;
      energy.before += std::abs(before - measured_J), energy.after += std::abs(after - measured_J),
          energy.measured += std::abs(measured_J);
    }
    if (pass == 0)
      for (std::size_t side = 0; side < 2; ++side)
        x[side] = fit[side].solve(std::vector<bool>(columns, true), 1e-4);
  }
  return answer({}, energy);
}

int run(const std::string& folder, const std::string& output) {
  const DataSet data = read_data_set(folder);
  std::vector<std::vector<Row>> rows;
  for (const Run& one : data.runs) rows.push_back(rows_of(data.robot, one, 3));
  const Weights weights = weights_of(rows);
  std::ofstream out(output);
  out << "{\"always_friction\": " << always_friction(rows, data.robot, weights)
      << ",\n \"plain_refit\": " << plain_refit(rows, data.robot, weights)
      << ",\n \"stlsq\": " << stlsq(rows, data.robot, weights) << ",\n \"black_box\": " << black_box(rows)
      << "}\n";
  if (!out.flush()) throw std::runtime_error("cannot write " + output);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: blind_controls DATA_SET_FOLDER OUT.json\n";
    return 2;
  }
  try {
    return run(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::cerr << "blind_controls: " << error.what() << "\n";
    return 2;
  }
}
