#include "diagnosis/calibration/smoothed_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "diagnosis/values/constant_payload.hpp"
#include "model/kinematics.hpp"
#include "model/median.hpp"

namespace joulepath::calibration {
namespace {

constexpr double kKernelDeviation_s = 0.15;
constexpr double kTurningSpeed_rad_s = 0.3;  ///< below this speed the sign of friction is uncertain
constexpr double kBraking_rad_s2 = 0.3;
constexpr double kLongestGap_periods = 2.5;

/// The channels that calibration needs, at even time steps without gaps.
struct Stretch {
  double start_s{};
  double period_s{};
  Sided<std::vector<double>> speed{}, current{}, voltage{};
  std::vector<double> payload{};
};

Sided<std::vector<double>> wheel_speeds(const Trajectory& log, const Geometry& geometry) {
  if (!log.wheel_speed_rad_s.left.empty() && !log.wheel_speed_rad_s.right.empty())
    return log.wheel_speed_rad_s;
  if (log.linear_speed_m_s.empty() || log.angular_speed_rad_s.empty()) return {};
  Sided<std::vector<double>> speeds;
  for (std::size_t i = 0; i < log.size(); ++i) {
    const Sided<double> wheels =
        wheel_speeds_rad_s(geometry, log.linear_speed_m_s[i], log.angular_speed_rad_s[i]);
    for (Side side : kSides) speeds[side].push_back(wheels[side]);
  }
  return speeds;
}

/// Mean step but for gaps: rounded stamps have another median.
double mean_period_s(const std::vector<double>& time_s) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < time_s.size(); ++i) steps.push_back(time_s[i] - time_s[i - 1]);
  const double longest_s = kLongestGap_periods * upper_median(steps);
  std::erase_if(steps, [&](double step_s) { return step_s >= longest_s; });
  return std::accumulate(steps.begin(), steps.end(), 0.0) / static_cast<double>(steps.size());
}

/// Samples [first, last) of a channel at even steps, unchanged where the log's steps are even.
std::vector<double> on_even_steps(const std::vector<double>& time_s, const std::vector<double>& values,
                                  std::size_t first, std::size_t last, double period_s, std::size_t count) {
  std::vector<double> even;
  std::size_t at = first;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = time_s[first] + static_cast<double>(i) * period_s;
    while (at + 2 < last && time_s[at + 1] < t) ++at;
    const double part = std::clamp((t - time_s[at]) / (time_s[at + 1] - time_s[at]), 0.0, 1.0);
    even.push_back(values[at] + part * (values[at + 1] - values[at]));
  }
  return even;
}

Stretch stretch_of(const Run& run, const Sided<std::vector<double>>& speeds, std::size_t first,
                   std::size_t last) {
  const Trajectory& log = run.log;
  const auto span = static_cast<double>(last - first - 1);
  Stretch stretch{.start_s = log.time_s[first],
                  .period_s = (log.time_s[last - 1] - log.time_s[first]) / span};
  double worst_s = 0;
  for (std::size_t i = first; i < last; ++i)
    worst_s = std::max(worst_s, std::abs(log.time_s[i] - stretch.start_s -
                                         static_cast<double>(i - first) * stretch.period_s));
  const bool even = worst_s < 0.01 * stretch.period_s;
  const auto cut = [&](const std::vector<double>& values) {
    if (values.empty()) return values;
    if (even)
      return std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(first),
                                 values.begin() + static_cast<std::ptrdiff_t>(last));
    return on_even_steps(log.time_s, values, first, last, stretch.period_s, last - first);
  };
  for (Side side : kSides) {
    stretch.speed[side] = cut(speeds[side]);
    stretch.current[side] = cut(log.motor_current_A[side]);
    stretch.voltage[side] = cut(log.motor_voltage_V[side]);
  }
  stretch.payload = log.payload_kg.empty() ? std::vector<double>(last - first, constant_payload_kg(run))
                                           : cut(log.payload_kg);
  return stretch;
}

bool turns_one_way(const std::vector<double>& speed, std::size_t center, std::size_t reach) {
  const double direction = speed[center] > 0 ? 1.0 : -1.0;
  for (std::size_t i = center - reach; i <= center + reach; ++i)
    if (!(direction * speed[i] > kTurningSpeed_rad_s)) return false;
  return true;
}

/// Where a wheel brakes; an unsigned current may have the opposite sign there.
struct Braking {
  std::vector<bool> at{};

  bool near(std::size_t center, std::size_t reach) const {
    for (std::size_t i = center - reach; i <= center + reach; ++i)
      if (at[i]) return true;
    return false;
  }
};

Braking braking(const std::vector<double>& speed, const SplineKernel& kernel) {
  Braking found{.at = std::vector<bool>(speed.size(), false)};
  for (std::size_t i = kernel.reach(); i + kernel.reach() < speed.size(); ++i) {
    const double acceleration = weighted(kernel.derivative, speed, i);
    found.at[i] = (speed[i] > 0 ? acceleration : -acceleration) < -kBraking_rad_s2;
  }
  return found;
}

void append_smoothed(const Stretch& stretch, SmoothedRun& run) {
  const SplineKernel& kernel = run.kernel;
  const std::size_t reach = kernel.reach(), count = stretch.payload.size();
  const Sided<Braking> braked{braking(stretch.speed.left, kernel), braking(stretch.speed.right, kernel)};
  for (std::size_t i = reach; i + reach < count; ++i) {
    if (stretch.payload[i - reach] != stretch.payload[i + reach]) continue;
    SmoothedSample sample{.time_s = stretch.start_s + static_cast<double>(i) * stretch.period_s,
                          .payload_kg = stretch.payload[i]};
    bool finite = true;
    for (Side side : kSides) {
      sample.speed_rad_s[side] = weighted(kernel.value, stretch.speed[side], i);
      sample.acceleration_rad_s2[side] = weighted(kernel.derivative, stretch.speed[side], i);
      sample.current_A[side] = weighted(kernel.value, stretch.current[side], i);
      sample.current_slope_A_s[side] = weighted(kernel.derivative, stretch.current[side], i);
      sample.voltage_V[side] = run.has_voltage ? weighted(kernel.value, stretch.voltage[side], i)
                                               : std::numeric_limits<double>::quiet_NaN();
      sample.turning[side] = turns_one_way(stretch.speed[side], i, reach) &&
                             !(run.unsigned_currents && braked[side].near(i, reach));
      finite =
          finite && std::isfinite(sample.acceleration_rad_s2[side]) && std::isfinite(sample.current_A[side]);
    }
    if (finite) run.samples.push_back(sample);
  }
}

std::optional<SmoothedRun> smoothed(const Run& source, const Geometry& geometry) {
  const Trajectory& log = source.log;
  const Sided<std::vector<double>> speeds = wheel_speeds(log, geometry);
  if (log.size() < 20 || speeds.left.empty() || log.motor_current_A.left.empty() ||
      log.motor_current_A.right.empty())
    return std::nullopt;
  const double period_s = mean_period_s(log.time_s);
  SmoothedRun run{.name = source.name,
                  .has_voltage = !log.motor_voltage_V.left.empty() && !log.motor_voltage_V.right.empty(),
                  .unsigned_currents = source.current_sign_from_motion,
                  .kernel = make_spline_kernel(period_s, kKernelDeviation_s)};
  for (Side side : kSides) run.speed_noise_rad_s += 0.5 * white_noise_deviation(speeds[side]);
  std::size_t first = 0;
  for (std::size_t i = 1; i <= log.size(); ++i) {
    if (i < log.size() && log.time_s[i] - log.time_s[i - 1] < kLongestGap_periods * period_s) continue;
    if (i - first > 2 * run.kernel.reach() + 1) append_smoothed(stretch_of(source, speeds, first, i), run);
    first = i;
  }
  return run;
}

}  // namespace

std::vector<SmoothedRun> smooth_runs(const Dataset& dataset) {
  std::vector<SmoothedRun> runs;
  for (std::size_t r = 0; r < dataset.runs.size(); ++r)
    if (std::optional<SmoothedRun> smooth = smoothed(dataset.runs[r], dataset.robot.geometry)) {
      runs.push_back(*std::move(smooth));
      runs.back().index = r;
    }
  return runs;
}

}  // namespace joulepath::calibration
