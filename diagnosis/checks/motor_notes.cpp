#include "diagnosis/checks/motor_notes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnosis/thresholds.hpp"
#include "model/printable.hpp"
#include "model/sided.hpp"

namespace joulepath {
namespace {

constexpr double kLagStep_s = 0.1;
constexpr double kLongestLag_s = 5.0;
constexpr double kLeastLag_s = 0.5;       ///< shorter delays are effects of the catalog
constexpr double kClearlyLate = 0.1;      ///< by which a shift raises the correlation of voltage and speed
constexpr double kFollowsWell = 0.9;      ///< correlation of a motor's voltage with its wheel's speed
constexpr double kLeastBackward_s = 1.0;  ///< of a wheel that turns backward

using Samples = std::vector<double>;

/// Values at equal steps of kLagStep_s; empty where a channel is absent.
Samples at_equal_steps(const Samples& time_s, const Samples& values) {
  Samples steps;
  constexpr double kMostSteps =
      20.0;  // per sample: a log with fewer samples, or another unit of time, has none
  if (values.size() != time_s.size() || time_s.size() < 2) return steps;
  if (!(time_s.back() - time_s.front() < kMostSteps * kLagStep_s * static_cast<double>(time_s.size())))
    return steps;
  std::size_t i = 0;
  for (double t = time_s.front(); t <= time_s.back(); t += kLagStep_s) {
    while (i + 1 < time_s.size() && time_s[i + 1] <= t) ++i;
    steps.push_back(values[i]);
  }
  return steps;
}

/// Of a[i] with b[i + lag].
double correlation(const Samples& a, const Samples& b, std::ptrdiff_t lag) {
  const std::ptrdiff_t n = std::min(std::ssize(a), std::ssize(b));
  double count = 0, sum_a = 0, sum_b = 0, aa = 0, bb = 0, ab = 0;
  for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, -lag); i < n && i + lag < n; ++i) {
    const double x = a[static_cast<std::size_t>(i)], y = b[static_cast<std::size_t>(i + lag)];
    count += 1, sum_a += x, sum_b += y, aa += x * x, bb += y * y, ab += x * y;
  }
  const double va = aa - sum_a * sum_a / count, vb = bb - sum_b * sum_b / count;
  return va > 0 && vb > 0 ? (ab - sum_a * sum_b / count) / std::sqrt(va * vb) : 0.0;
}

/// By how much the motor's voltage is logged after (positive) or before its wheel's speed; 0: in time. A
/// heavy robot's voltage leads its speed, and equal drives follow themselves: a shift that is no delay is
/// compared with the best short one.
double lag_s(const Run& run, Side side) {
  const Samples voltage = at_equal_steps(run.log.time_s, run.log.motor_voltage_V[side]);
  const Samples speed = at_equal_steps(run.log.time_s, run.log.wheel_speed_rad_s[side]);
  if (voltage.empty() || speed.empty()) return 0.0;
  const int most = std::min(static_cast<int>(kLongestLag_s / kLagStep_s), static_cast<int>(speed.size()) / 4);
  const int shortest = std::min(most, static_cast<int>(kLeastLag_s / kLagStep_s));
  struct Shift {
    int lag{};
    double correlation{};
  };
  const auto best_within = [&](int reach) {
    Shift best{.lag = 0, .correlation = correlation(speed, voltage, 0)};
    for (int lag = -reach; lag <= reach; ++lag)
      if (const double found = correlation(speed, voltage, lag); found > best.correlation)
        best = {lag, found};
    return best;
  };
  const Shift best = best_within(most), in_time = best_within(shortest);
  const bool late = best.correlation > kFollowsWell && best.correlation > in_time.correlation + kClearlyLate;
  return late ? best.lag * kLagStep_s : 0.0;
}

/// Whether the current is never clearly negative although the wheel turns backward for a while.
bool lacks_sign(const Run& run, Side side) {
  const Samples &current = run.log.motor_current_A[side], &speed = run.log.wheel_speed_rad_s[side];
  if (current.size() != run.log.size() || speed.size() != run.log.size()) return false;
  double backward_s = 0, positive_A = 0, negative_A = 0;
  for (std::size_t i = 1; i < current.size(); ++i) {
    if (speed[i] < -kMovingWheel_rad_s) backward_s += run.log.time_s[i] - run.log.time_s[i - 1];
    positive_A = std::max(positive_A, current[i]), negative_A = std::min(negative_A, current[i]);
  }
  return backward_s > kLeastBackward_s && -negative_A < 0.01 * positive_A;
}

std::string motor_name(const char* quantity, Side side, const char* unit) {
  return std::string("motor_") + quantity + "_" + side_name(side) + "_" + unit;
}

}  // namespace

std::vector<std::string> motor_notes(const Dataset& dataset) {
  std::vector<std::string> notes;
  for (const Side side : kSides) {
    const auto unsigned_run =
        std::ranges::find_if(dataset.runs, [side](const Run& run) { return lacks_sign(run, side); });
    if (unsigned_run != dataset.runs.end()) {
      const std::string column = motor_name("current", side, "A");
      std::string note = unsigned_run->name + ": ";
      note.append(column).append(" is never negative, although its wheel turns backward: is its sign lost? ");
      note.append("columns: {").append(column).append(": {unsigned: true}} takes the sign from the wheel");
      notes.push_back(std::move(note));
    }
    const auto late =
        std::ranges::find_if(dataset.runs, [side](const Run& run) { return lag_s(run, side) != 0.0; });
    if (late == dataset.runs.end()) continue;
    const double lag = lag_s(*late, side);
    std::string note = late->name + ": ";
    note.append(motor_name("voltage", side, "V")).append(" follows its wheel about ");
    note.append(four_digits(std::abs(lag))).append(lag > 0 ? " s late" : " s early");
    note.append(": do motors and wheels have one clock? Logs are joined by their times, not by rows");
    notes.push_back(std::move(note));
  }
  return notes;
}

}  // namespace joulepath
