#include "diagnosis/where/gap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "diagnosis/numerics/parallel.hpp"
#include "diagnosis/numerics/resample.hpp"
#include "diagnosis/prediction/rows.hpp"
#include "diagnosis/signals/site.hpp"
#include "diagnosis/thresholds.hpp"
#include "model/normal_quantiles.hpp"
#include "model/student_t.hpp"

namespace joulepath {
namespace {

/// Whether a run's energy there is the battery's.
bool is_at_battery(const RunSignals& run, EnergyAt at) {
  return run.size() > 0 && run.battery_power_W.size() == run.size() &&
         (at == EnergyAt::battery || !measures_motors(run));
}

double shrink(const std::vector<RunEnergy>& before, const std::vector<RunEnergy>& after,
              const std::vector<std::size_t>& runs) {
  double old_J = 0, new_J = 0;
  for (std::size_t r : runs) old_J += std::abs(before[r].gap_J()), new_J += std::abs(after[r].gap_J());
  return old_J > 0 ? 1 - new_J / old_J : 0.0;
}

/// How much wider than a bootstrap's percentiles an interval from `runs` runs is: Student's t, and the
/// variance that resampling few takes off.
double small_sample_factor(std::size_t runs) {
  const auto n = static_cast<double>(runs);
  if (runs < 2) return 1.0;
  return student_t_975(n - 1) / kNormal95 * std::sqrt(n / (n - 1));
}

/// 95 % interval of the shrink on another day's runs: runs resampled about the shrink that is said.
Range95 shrink_interval(const GapInput& input, EnergyAt at, std::vector<RunEnergy> before,
                        std::vector<RunEnergy> after, const EnergyGap& energy) {
  const std::size_t held_out = before.size();
  if (held_out == 0 || input.bootstrap == 0 || energy.before_J <= 0) return {};
  if (held_out < kFewHeldOut) {
    const std::size_t fitted = input.fitted_signals.size();
    for (const RunEnergy& run : run_energies(input.fitted_signals, ModelPoints(fitted, input.before), at))
      before.push_back(run);
    for (const RunEnergy& run : run_energies(input.fitted_signals, ModelPoints(fitted, input.fitted), at))
      after.push_back(run);
  }
  const auto [low, high] =
      bootstrap_interval(before.size(), input.bootstrap, [&](std::vector<std::size_t> runs) {
        runs.resize(held_out);
        return shrink(before, after, runs);
      });
  const double said = energy.shrink_fraction, wider = small_sample_factor(before.size()),
               day = kAnotherDay * energy.noise_floor_percent / energy.before_percent;
  return {said - wider * std::max(0.0, said - low) - day,
          std::min(1.0, said + wider * std::max(0.0, high - said) + day)};
}

/// Root mean square of a residual over samples and runs.
struct MeanSquare {
  double sum{}, count{};
  void add(const Eigen::VectorXd& residual) {
    sum += residual.squaredNorm(), count += static_cast<double>(residual.size());
  }
  double root() const { return count > 0 ? std::sqrt(sum / count) : 0.0; }
};

struct Squares {
  MeanSquare current{}, voltage{}, position{}, heading{}, battery{};
};

Squares squares_of(const std::vector<RunSignals>& signals, const ModelPoints& points) {
  Squares squares;
  for (std::size_t r = 0; r < signals.size(); ++r) {
    const RunSignals& run = signals[r];
    const ModelPoint& point = points[r];
    const Prediction p = predict(run, point);
    for (Side side : kSides) {
      if (run.motor_current_A[side].size() == run.size())
        squares.current.add(run.motor_current_A[side] - p.current_A[side]);
      if (run.motor_voltage_V[side].size() == run.size())
        squares.voltage.add(run.motor_voltage_V[side] - p.voltage_V[side]);
    }
    const ResidualRows rows = residual_rows(run, point, p);
    if (rows.present.col(kPositionX).any())
      squares.position.add(rows.value.col(kPositionX)), squares.position.add(rows.value.col(kPositionY));
    if (rows.present.col(kHeading).any()) squares.heading.add(rows.value.col(kHeading));
    if (run.battery_power_W.size() == run.size())
      squares.battery.add(run.battery_power_W - p.battery_power_W);
  }
  return squares;
}

EnergyGap energy_gap(const GapInput& input, EnergyAt at, double noise_floor_percent) {
  const std::vector<RunEnergy> before =
      run_energies(input.before_signals, ModelPoints(input.before_signals.size(), input.before), at);
  const std::vector<RunEnergy> after = run_energies(input.after_signals, input.after, at);
  EnergyGap energy;
  energy.before_percent = energy_gap_percent(before);
  energy.after_percent = energy_gap_percent(after);
  energy.bias_before_percent = energy_bias_percent(before);
  energy.bias_after_percent = energy_bias_percent(after);
  energy.noise_floor_percent = noise_floor_percent;
  energy.before_J = absolute_gap_J(before);
  energy.after_J = absolute_gap_J(after);
  energy.shrink_fraction = energy.before_J > 0 ? 1 - energy.after_J / energy.before_J : 0.0;
  energy.shrink_interval_95 = shrink_interval(input, at, before, after, energy);
  return energy;
}

SignalGap signal_gap(const MeanSquare& before, const MeanSquare& after) {
  return {.before_rms = before.root(), .after_rms = after.root(), .present = before.count > 0};
}

void add_phases(const std::vector<RunSignals>& signals, const ModelPoints& points, bool after,
                std::map<std::string, std::pair<double, double>>& phases) {
  for (std::size_t r = 0; r < signals.size(); ++r) {
    const RunSignals& run = signals[r];
    const ModelPoint& point = points[r];
    const Prediction p = predict(run, point);
    std::map<std::string, double> energy_J;
    if (!measures_motors(run) && measures_energy(run))
      for (Eigen::Index j = 0; j < run.size(); ++j)
        energy_J[phase_of(run, point.robot.geometry, j)] +=
            (p.battery_power_W[j] - run.battery_power_W[j]) * run.period_s;
    for (Side side : kSides) {
      const Eigen::VectorXd measured = measured_power_W(run, side);
      for (Eigen::Index j = 0; j < measured.size(); ++j)
        energy_J[phase_of(run, point.robot.geometry, j)] += (p.power_W[side][j] - measured[j]) * run.period_s;
    }
    for (const auto& [phase, value] : energy_J)
      (after ? phases[phase].second : phases[phase].first) += std::abs(value);
  }
}

}  // namespace

Eigen::VectorXd measured_power_W(const RunSignals& run, Side side) {
  if (run.motor_power_W[side].size() == run.size()) return run.motor_power_W[side];
  return {};
}

std::vector<RunEnergy> run_energies(const std::vector<RunSignals>& signals, const ModelPoints& points,
                                    EnergyAt at) {
  std::vector<RunEnergy> energies(signals.size());
  parallel_for(signals.size(), [&](std::size_t r) {
    const Prediction p = predict(signals[r], points[r]);
    if (is_at_battery(signals[r], at)) {
      energies[r] = {.measured_J = signals[r].battery_power_W.sum() * signals[r].period_s,
                     .predicted_J = p.battery_power_W.sum() * signals[r].period_s};
      return;
    }
    if (at == EnergyAt::battery) return;
    for (Side side : kSides) {
      const Eigen::VectorXd measured = measured_power_W(signals[r], side);
      if (measured.size() == 0) continue;
      energies[r].measured_J += measured.sum() * signals[r].period_s;
      energies[r].predicted_J += p.power_W[side].sum() * signals[r].period_s;
    }
  });
  return energies;
}

bool measures_both_energies(const std::vector<RunSignals>& signals) {
  return std::ranges::any_of(signals, [](const RunSignals& run) {
    return is_at_battery(run, EnergyAt::battery) && !is_at_battery(run, EnergyAt::motors_first);
  });
}

double absolute_gap_J(const std::vector<RunEnergy>& runs) {
  double sum = 0;
  for (const RunEnergy& run : runs) sum += std::abs(run.gap_J());
  return sum;
}

double energy_gap_percent(const std::vector<RunEnergy>& runs) {
  double gap = 0, measured = 0;
  for (const RunEnergy& run : runs) gap += std::abs(run.gap_J()), measured += std::abs(run.measured_J);
  return measured > 0 ? 100 * gap / measured : 0.0;
}

double energy_bias_percent(const std::vector<RunEnergy>& runs) {
  double gap = 0, measured = 0;
  for (const RunEnergy& run : runs) gap += run.gap_J(), measured += std::abs(run.measured_J);
  return measured > 0 ? 100 * gap / measured : 0.0;
}

double run_scatter_percent(const std::vector<RunSignals>& signals, const ModelPoint& point,
                           const Eigen::VectorXd& run_variance, const NoiseModel& noise, EnergyAt at) {
  double expected_J = 0, measured_J = 0;
  for (const RunSignals& run : signals) {
    const Prediction p = predict(run, point);
    double variance = 0;
    const bool at_battery = is_at_battery(run, at);
    if (at == EnergyAt::battery && !at_battery) continue;
    if (at_battery) {
      measured_J += run.battery_power_W.sum() * run.period_s;
      const double duration_s = run.period_s * static_cast<double>(run.size());
      variance = duration_s * run.period_s * std::pow(noise.channel_sd[kDriverPower], 2) +
                 run_variance[5] * duration_s * duration_s;
    }
    for (Side side : kSides) {
      const Eigen::VectorXd measured = at_battery ? p.power_W[side] : measured_power_W(run, side);
      if (measured.size() == 0) continue;
      if (!at_battery) measured_J += measured.sum() * run.period_s;
      const Motor& motor = point.robot.motor[side];
      const int s = side == Side::left ? 0 : 1;
      double per_torque_J = 0, per_ohm_J = 0, reading_J2 = 0;
      for (Eigen::Index j = 0; j < run.size(); ++j) {
        const double direction = run.direction(side, j);
        const double watts_per_ampere = p.voltage_V[side][j] + motor.resistance_ohm * p.current_A[side][j];
        per_torque_J += run.period_s * watts_per_ampere * direction / motor.torque_per_ampere_Nm_A();
        per_ohm_J += run.period_s * p.current_A[side][j] * p.current_A[side][j];
        if (!at_battery)
          reading_J2 += std::pow(run.period_s * watts_per_ampere * noise.channel_sd[kCurrentLeft + s], 2);
      }
      variance += run_variance[s] * per_torque_J * per_torque_J +
                  run_variance[2 + s] * per_ohm_J * per_ohm_J + reading_J2;
    }
    expected_J += std::sqrt(variance * 2 / std::numbers::pi);
  }
  return measured_J > 0 ? 100 * expected_J / measured_J : 0.0;
}

GapReport measure_gap(const GapInput& input) {
  GapReport report{.energy = energy_gap(input, EnergyAt::motors_first, input.noise_floor_percent)};
  if (measures_both_energies(input.before_signals))
    report.battery_energy = energy_gap(input, EnergyAt::battery, input.battery_floor_percent);
  const ModelPoints nominal(input.before_signals.size(), input.before);
  const Squares a = squares_of(input.before_signals, nominal),
                b = squares_of(input.after_signals, input.after);
  report.current_A = signal_gap(a.current, b.current);
  report.voltage_V = signal_gap(a.voltage, b.voltage);
  report.position_m = signal_gap(a.position, b.position);
  report.heading_rad = signal_gap(a.heading, b.heading);
  report.battery_W = signal_gap(a.battery, b.battery);
  add_phases(input.before_signals, nominal, false, report.energy_by_phase_J);
  add_phases(input.after_signals, input.after, true, report.energy_by_phase_J);
  return report;
}

bool shrinks_a_signal(const std::vector<RunSignals>& before_signals, const ModelPoints& before,
                      const std::vector<RunSignals>& after_signals, const ModelPoints& after) {
  const Squares a = squares_of(before_signals, before), b = squares_of(after_signals, after);
  constexpr std::array kSignals{&Squares::current, &Squares::voltage, &Squares::position, &Squares::heading,
                                &Squares::battery};
  const auto some_is_smaller = [&](const Squares& one, const Squares& other) {
    return std::ranges::any_of(kSignals, [&](MeanSquare Squares::*signal) {
      return (one.*signal).root() < (1 - kNotableShrink) * (other.*signal).root();
    });
  };
  return some_is_smaller(b, a) && !some_is_smaller(a, b);
}

const char* phase_of(const RunSignals& run, const Geometry& geometry, Eigen::Index j) {
  const BodyMotion<double> motion = run.rolled_motion(geometry, j);
  if (stands(geometry, motion)) return "standstill";
  const double across_m_s = std::abs(motion.yaw_rate_rad_s) * geometry.half_track_m;
  const double along_m_s = std::abs(motion.speed_m_s);
  if (across_m_s > kSpinRatio * along_m_s) return "spin";
  if (across_m_s > kTurnRatio * along_m_s + kTurnAcross_m_s) return "turn";
  const double gain = motion.acceleration_m_s2 * (motion.speed_m_s > 0 ? 1 : -1);
  return gain > kCruise_m_s2 ? "accelerate" : gain < -kCruise_m_s2 ? "brake" : "cruise";
}

}  // namespace joulepath
