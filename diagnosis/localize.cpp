#include "diagnosis/localize.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

#include "diagnosis/resample.hpp"
#include "model/kinematics.hpp"

namespace joulepath {
namespace {

struct Amount {
  double gap_J{};    ///< sum of |predicted - measured|
  double noise_J{};  ///< what noise alone gives
  double excess_J() const { return std::max(0.0, gap_J - noise_J); }
  void add(double gap, double noise) { gap_J += gap, noise_J += noise; }
};

/// axis -> value -> run -> amount
using Ledger = std::map<std::string, std::map<std::string, std::vector<Amount>>>;

std::string range_text(double low, double high, const char* unit) {
  char text[160];
  std::snprintf(text, sizeof text, "%g to %g %s", low, high, unit);
  return text;
}

std::string number_text(double value, const char* unit) {
  char text[96];
  std::snprintf(text, sizeof text, "%g %s", std::round(100 * value) / 100, unit);
  return text;
}

std::string speed_cell(double speed_m_s) {
  const double low = 0.2 * std::floor(std::abs(speed_m_s) / 0.2 + 1e-9);
  return range_text(low, low + 0.2, "m/s");
}

std::string heading_cell(double heading_rad) {
  const double turn = heading_rad / (2 * std::numbers::pi);
  const int octant = static_cast<int>(std::floor((turn - std::floor(turn)) * 8 + 0.5)) % 8;
  return number_text(octant * 45.0, "deg");
}

std::string floor_cell(double x_m, double y_m) {
  char text[160];
  std::snprintf(text, sizeof text, "x %g to %g m, y %g to %g m", std::floor(x_m), std::floor(x_m) + 1,
                std::floor(y_m), std::floor(y_m) + 1);
  return text;
}

class Localizer {
 public:
  Localizer(const std::vector<RunSignals>& signals, const ModelPoint& nominal, const NoiseModel& noise)
      : runs_(signals.size()), nominal_(nominal), noise_(noise) {
    for (std::size_t r = 0; r < runs_; ++r) add_run(signals[r], r);
  }
  const Ledger& ledger() const { return ledger_; }

 private:
  void book(const std::string& axis, const std::string& value, std::size_t run, double gap, double noise) {
    std::vector<Amount>& cell = ledger_[axis][value];
    if (cell.empty()) cell.resize(runs_);
    cell[run].add(gap, noise);
  }

  /// Mean size of the power's error that sensor noise makes.
  double noise_W(double voltage_V, double current_A, Side side) const {
    const std::size_t s = side == Side::left ? 0 : 1;
    const double sd_A = noise_.channel_sd[kCurrentLeft + s], ohm = nominal_.robot.motor[side].resistance_ohm;
    const double winding_V = noise_.channel_sd[kWindingLeft + s];
    const double sd_V2 =
        std::max(winding_V * winding_V - ohm * ohm * sd_A * sd_A, 0.1 * winding_V * winding_V);
    return std::sqrt(2 / std::numbers::pi *
                     (voltage_V * voltage_V * sd_A * sd_A + current_A * current_A * sd_V2));
  }

  void add_run(const RunSignals& run, std::size_t r) {
    const Prediction p = predict(run, nominal_);
    const ResidualRows rows = residual_rows(run, nominal_, p);
    for (Side side : kSides) {
      const Eigen::VectorXd measured = measured_power_W(run, side);
      for (Eigen::Index j = 0; j < measured.size(); ++j) {
        const double gap = std::abs(p.power_W[side][j] - measured[j]) * run.period_s;
        const double noise = noise_W(p.voltage_V[side][j], p.current_A[side][j], side) * run.period_s;
        book_sample(run, r, side, j, gap, noise);
        book_channels(rows, p, r, side, j, run.period_s);
      }
    }
  }

  void book_sample(const RunSignals& run, std::size_t r, Side side, Eigen::Index j, double gap,
                   double noise) {
    const Twist<double> twist =
        body_twist(nominal_.robot.geometry,
                   Sided<double>{run.wheel_speed_rad_s.left[j], run.wheel_speed_rad_s.right[j]});
    book("phase", phase_of(run, nominal_.robot.geometry, j), r, gap, noise);
    book("wheel", side_name(side), r, gap, noise);
    book("speed", speed_cell(twist.speed_m_s), r, gap, noise);
    book("payload", number_text(run.payload_kg[j], "kg"), r, gap, noise);
    book("run", run.name, r, gap, noise);
    const bool moving = std::abs(twist.speed_m_s) > 0.02;
    book("direction", !moving ? "in place" : twist.speed_m_s > 0 ? "forward" : "reverse", r, gap, noise);
    if (run.heading_measured) book("heading", heading_cell(run.heading_rad[j]), r, gap, noise);
    if (run.x_m.size() > 0) book("floor", floor_cell(run.x_m[j], run.y_m[j]), r, gap, noise);
    if (run.time_of_day_known) {
      const double low = 60 * std::floor(run.time_of_day_s[j] / 60);
      book("time_of_day", range_text(low, low + 60, "s"), r, gap, noise);
    }
  }

  /// The same gap by the equation that it breaks, each in watts.
  void book_channels(const ResidualRows& rows, const Prediction& p, std::size_t r, Side side, Eigen::Index j,
                     double dt) {
    const int s = side == Side::left ? 0 : 1;
    const double volts = std::abs(p.voltage_V[side][j]), amperes = std::abs(p.current_A[side][j]);
    const auto sd = [&](int c) {
      return std::sqrt(2 / std::numbers::pi) * noise_.channel_sd[static_cast<std::size_t>(c)];
    };
    if (rows.present(j, kCurrentLeft + s))
      book("channel", "current", r, volts * std::abs(rows.value(j, kCurrentLeft + s)) * dt,
           volts * sd(kCurrentLeft + s) * dt);
    if (rows.present(j, kWindingLeft + s))
      book("channel", "voltage", r, amperes * std::abs(rows.value(j, kWindingLeft + s)) * dt,
           amperes * sd(kWindingLeft + s) * dt);
    if (s == 0 && rows.present(j, kDriverPower))
      book("channel", "battery", r, std::abs(rows.value(j, kDriverPower)) * dt, sd(kDriverPower) * dt);
  }

  std::size_t runs_;
  const ModelPoint& nominal_;
  const NoiseModel& noise_;
  Ledger ledger_{};
};

Amount sum_over(const std::vector<Amount>& cell, const std::vector<std::size_t>& runs) {
  Amount sum;
  for (std::size_t r : runs) sum.add(cell[r].gap_J, cell[r].noise_J);
  return sum;
}

}  // namespace

std::vector<WhereCell> localize_gap(const std::vector<RunSignals>& signals, const ModelPoint& nominal,
                                    const NoiseModel& noise, std::size_t bootstrap) {
  const Localizer localizer(signals, nominal, noise);
  std::vector<std::size_t> all(signals.size());
  for (std::size_t r = 0; r < all.size(); ++r) all[r] = r;
  std::vector<WhereCell> cells;
  for (const char* axis : {"phase", "wheel", "speed", "payload", "floor", "heading", "direction",
                           "time_of_day", "channel", "run"}) {
    const auto found = localizer.ledger().find(axis);
    if (found == localizer.ledger().end()) continue;
    const auto share_of = [&](const std::string& value, const std::vector<std::size_t>& runs) {
      double total = 0, mine = 0;
      for (const auto& [name, cell] : found->second) {
        const double excess = sum_over(cell, runs).excess_J();
        total += excess;
        if (name == value) mine = excess;
      }
      return total > 0 ? mine / total : 0.0;
    };
    std::vector<WhereCell> of_axis;
    const bool many = found->second.size() > 40;
    for (const auto& [value, cell] : found->second) {
      WhereCell where{.axis = axis,
                      .value = value,
                      .share_of_gap = share_of(value, all),
                      .energy_J = sum_over(cell, all).excess_J()};
      if (!many || where.share_of_gap > 0.01)
        where.interval_95 =
            bootstrap_interval(signals.size(), many ? bootstrap / 4 : bootstrap,
                               [&](const std::vector<std::size_t>& runs) { return share_of(value, runs); });
      of_axis.push_back(std::move(where));
    }
    std::stable_sort(of_axis.begin(), of_axis.end(),
                     [](const WhereCell& a, const WhereCell& b) { return a.share_of_gap > b.share_of_gap; });
    cells.insert(cells.end(), of_axis.begin(), of_axis.end());
  }
  return cells;
}

}  // namespace joulepath
