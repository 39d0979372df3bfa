#include "diagnosis/where/localize.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <utility>

#include "diagnosis/prediction/rows.hpp"
#include "diagnosis/thresholds.hpp"
#include "diagnosis/where/gap_ledger.hpp"
// Design: docs/decisions/0510-where-the-gap-lies.md

namespace joulepath {
namespace {

std::string speed_cell(double speed_m_s) {
  const double low = kSpeedCell_m_s * std::floor(std::abs(speed_m_s) / kSpeedCell_m_s + 1e-9);
  return range_text(low, low + kSpeedCell_m_s, "m/s");
}

std::string heading_cell(double heading_rad) {
  const double turn = heading_rad / (2 * std::numbers::pi);
  const int octant =
      static_cast<int>(std::floor((turn - std::floor(turn)) * kHeadingCells + 0.5)) % kHeadingCells;
  return number_text(octant * 360.0 / kHeadingCells, "deg");
}

std::string floor_cell(double x_m, double y_m) {
  char text[160];
  const double x = kFloorCell_m * std::floor(x_m / kFloorCell_m),
               y = kFloorCell_m * std::floor(y_m / kFloorCell_m);
  std::snprintf(text, sizeof text, "x %g to %g m, y %g to %g m", x, x + kFloorCell_m, y, y + kFloorCell_m);
  return text;
}

/// Standard deviations of means over 0, 1, 2, ... samples of a noise, relative to that of one sample.
std::vector<double> noise_of_means(const Autoregression& noise, Eigen::Index most) {
  const auto& [first, second] = noise.coefficient;
  double before = 1.0,
         here = first / (1 - second);  // correlations with the sample before, and the one before
  double sum = 0.0, weighted = 0.0;    // of the correlations at lags k, and of k times them
  std::vector<double> sd{0.0};
  for (Eigen::Index n = 1; n <= most; ++n) {
    const auto count = static_cast<double>(n);
    sd.push_back(std::sqrt(std::max(0.0, count + 2 * (count * sum - weighted))) / count);
    sum += here;
    weighted += count * here;
    before = std::exchange(here, first * here + second * before);
  }
  return sd;
}

/// Means over up to `half` samples on either side.
class MovingMean {
 public:
  MovingMean(const Eigen::VectorXd& values, Eigen::Index half) : half_(half), sums_(values.size() + 1) {
    sums_[0] = 0;
    for (Eigen::Index j = 0; j < values.size(); ++j) sums_[j + 1] = sums_[j] + values[j];
  }
  Eigen::Index count(Eigen::Index j) const { return end(j) - begin(j); }
  double at(Eigen::Index j) const {
    return (sums_[end(j)] - sums_[begin(j)]) / static_cast<double>(count(j));
  }

 private:
  Eigen::Index begin(Eigen::Index j) const { return std::max<Eigen::Index>(0, j - half_); }
  Eigen::Index end(Eigen::Index j) const { return std::min(sums_.size() - 1, j + half_ + 1); }

  Eigen::Index half_;
  Eigen::VectorXd sums_;
};

class Localizer {
 public:
  Localizer(const std::vector<RunSignals>& signals, const ModelPoint& nominal, const NoiseModel& noise)
      : nominal_(nominal), noise_(noise), ledger_(signals.size()) {
    for (std::size_t r = 0; r < signals.size(); ++r) add_run(signals[r], r);
  }
  const GapLedger& ledger() const { return ledger_; }

 private:
  /// Mean absolute error, caused by sensor noise, of a mean of the power over `count` samples. Without a
  /// voltage channel, V is computed from the measured current, whose error then enters there, too.
  double noise_W(double voltage_V, double current_A, Side side, bool voltage_measured,
                 Eigen::Index count) const {
    const std::size_t s = side == Side::left ? 0 : 1;
    const double sd_A = sd_of_mean(kCurrentLeft + s, count), ohm = nominal_.robot.motor[side].resistance_ohm;
    if (!voltage_measured)
      return std::sqrt(2 / std::numbers::pi) * std::abs(voltage_V + ohm * current_A) * sd_A;
    const double winding_V = sd_of_mean(kWindingLeft + s, count);
    const double sd_V2 =
        std::max(winding_V * winding_V - ohm * ohm * sd_A * sd_A, kLeastVoltageNoise * winding_V * winding_V);
    return std::sqrt(2 / std::numbers::pi *
                     (voltage_V * voltage_V * sd_A * sd_A + current_A * current_A * sd_V2));
  }

  double sd_of_mean(std::size_t channel, Eigen::Index count) const {
    return noise_.channel_sd[channel] * means_[channel][static_cast<std::size_t>(count)];
  }

  void add_run(const RunSignals& run, std::size_t r) {
    const Prediction p = predict(run, nominal_);
    const ResidualRows rows = residual_rows(run, nominal_, p);
    const auto half = std::lround(kGapWindow_s / run.period_s);
    for (std::size_t c : {kCurrentLeft, kCurrentRight, kWindingLeft, kWindingRight, kDriverPower})
      means_[c] = noise_of_means(noise_.memory[c], 2 * half + 1);
    if (!measures_motors(run) && measures_energy(run)) add_battery(run, p, rows, r, half);
    for (Side side : kSides) {
      const Eigen::VectorXd measured = measured_power_W(run, side);
      if (measured.size() == 0) continue;
      const MovingMean gap_W(p.power_W[side] - measured, half);
      for (Eigen::Index j = 0; j < measured.size(); ++j) {
        const double noise = noise_W(p.voltage_V[side][j], p.current_A[side][j], side,
                                     run.motor_voltage_V[side].size() > 0, gap_W.count(j));
        book_sample(run, r, side, j,
                    {.gap_J = std::abs(gap_W.at(j)) * run.period_s,
                     .noise_J = noise * run.period_s,
                     .signed_J = (p.power_W[side][j] - measured[j]) * run.period_s,
                     .measured_J = std::abs(measured[j]) * run.period_s});
        book_channels(rows, p, r, side, j, run.period_s);
      }
    }
  }

  /// Adds the power at the battery's terminals where the motors are not measured; no wheel is attributed.
  void add_battery(const RunSignals& run, const Prediction& p, const ResidualRows& rows, std::size_t r,
                   Eigen::Index half) {
    const MovingMean gap_W(p.battery_power_W - run.battery_power_W, half);
    for (Eigen::Index j = 0; j < run.size(); ++j) {
      const double noise_W = std::sqrt(2 / std::numbers::pi) * sd_of_mean(kDriverPower, gap_W.count(j));
      book_sample(run, r, std::nullopt, j,
                  {.gap_J = std::abs(gap_W.at(j)) * run.period_s,
                   .noise_J = noise_W * run.period_s,
                   .signed_J = (p.battery_power_W[j] - run.battery_power_W[j]) * run.period_s,
                   .measured_J = std::abs(run.battery_power_W[j]) * run.period_s});
      book_channels(rows, p, r, Side::left, j, run.period_s);
    }
  }

  void book_sample(const RunSignals& run, std::size_t r, std::optional<Side> side, Eigen::Index j,
                   const GapAmount& amount) {
    const double speed_m_s = run.rolled_motion(nominal_.robot.geometry, j).speed_m_s;
    ledger_.book("phase", phase_of(run, nominal_.robot.geometry, j), r, amount);
    if (side) ledger_.book("wheel", side_name(*side), r, amount);
    ledger_.book("speed", speed_cell(speed_m_s), r, amount);
    ledger_.book("payload", run.payload_known ? number_text(run.payload_kg[j], "kg") : "not stated", r,
                 amount);
    ledger_.book("run", run.name, r, amount);
    const bool moving = std::abs(speed_m_s) > kStandstillAlong_m_s;
    ledger_.book("direction", !moving ? "in place" : speed_m_s > 0 ? "forward" : "reverse", r, amount);
    if (run.heading_measured) ledger_.book("heading", heading_cell(run.heading_rad[j]), r, amount);
    if (run.x_m.size() > 0) ledger_.book("floor", floor_cell(run.x_m[j], run.y_m[j]), r, amount);
    if (run.time_of_day_known) {
      const double low = kTimeCell_s * std::floor(run.time_of_day_s[j] / kTimeCell_s);
      ledger_.book("time_of_day", range_text(low, low + kTimeCell_s, "s"), r, amount);
    }
  }

  /// Adds the same gap by the violated equation, each in watts.
  void book_channels(const ResidualRows& rows, const Prediction& p, std::size_t r, Side side, Eigen::Index j,
                     double dt) {
    const int s = side == Side::left ? 0 : 1;
    const double volts = std::abs(p.voltage_V[side][j]), amperes = std::abs(p.current_A[side][j]);
    const auto sd = [&](int c) {
      return std::sqrt(2 / std::numbers::pi) * noise_.channel_sd[static_cast<std::size_t>(c)];
    };
    if (rows.present(j, kCurrentLeft + s))
      ledger_.book("channel", "current", r,
                   {.gap_J = volts * std::abs(rows.value(j, kCurrentLeft + s)) * dt,
                    .noise_J = volts * sd(kCurrentLeft + s) * dt});
    if (rows.present(j, kWindingLeft + s))
      ledger_.book("channel", "voltage", r,
                   {.gap_J = amperes * std::abs(rows.value(j, kWindingLeft + s)) * dt,
                    .noise_J = amperes * sd(kWindingLeft + s) * dt});
    if (s == 0 && rows.present(j, kDriverPower))
      ledger_.book("channel", "battery", r,
                   {.gap_J = std::abs(rows.value(j, kDriverPower)) * dt, .noise_J = sd(kDriverPower) * dt});
  }

  const ModelPoint& nominal_;
  const NoiseModel& noise_;
  std::array<std::vector<double>, kChannelCount> means_{};  ///< noise_of_means() at the run's period
  GapLedger ledger_;
};

}  // namespace

std::vector<WhereCell> localize_gap(const std::vector<RunSignals>& signals, const ModelPoint& nominal,
                                    const NoiseModel& noise, std::size_t bootstrap) {
  return Localizer(signals, nominal, noise)
      .ledger()
      .cells({"phase", "wheel", "speed", "payload", "floor", "heading", "direction", "time_of_day", "channel",
              "run"},
             bootstrap);
}

}  // namespace joulepath
