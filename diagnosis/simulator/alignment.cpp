#include "diagnosis/simulator/alignment.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/numerics/smoothing.hpp"
#include "diagnosis/thresholds.hpp"

namespace joulepath {
namespace {

using Times = std::vector<double>;

Times times_of(const Eigen::VectorXd& values) { return {values.begin(), values.end()}; }

/// Share of the wheels' travel at each sample, 0 to 1. A little of it is time, so that it increases at rest.
Times progress_of(const RunSignals& run) {
  Times progress(static_cast<std::size_t>(run.size()));
  const Eigen::VectorXd speed =
      0.5 * (run.wheel_speed_rad_s.left.cwiseAbs() + run.wheel_speed_rad_s.right.cwiseAbs());
  const double at_rest = kTravelOfRest * speed.mean();
  for (std::size_t j = 1; j < progress.size(); ++j) {
    const auto here = static_cast<Eigen::Index>(j);
    progress[j] = progress[j - 1] + 0.5 * (speed[here] + speed[here - 1]) + at_rest;
  }
  const double whole = progress.empty() ? 0.0 : progress.back();
  for (double& share : progress) share = whole > 0 ? share / whole : 0.0;
  return progress;
}

/// Root mean square of the difference of both wheels' speeds over that of the robot's.
double motion_difference(const RunSignals& real, const RunSignals& simulated, const Times& real_time_s) {
  const Times at_s = times_of(real.time_s);
  double difference = 0, square = 0;
  for (Side side : kSides) {
    const Times there = interpolate(real_time_s, times_of(simulated.wheel_speed_rad_s[side]), at_s);
    const Eigen::VectorXd& here = real.wheel_speed_rad_s[side];
    difference += (Eigen::Map<const Eigen::VectorXd>(there.data(), here.size()) - here).squaredNorm();
    square += here.squaredNorm();
  }
  const double least =
      2 * static_cast<double>(real.size()) * kLeastTurningSpeed_rad_s * kLeastTurningSpeed_rad_s;
  return std::sqrt(difference / std::max(least, square));
}

bool has_commands(const Trajectory& log) {
  return !log.command_linear_speed_m_s.empty() && !log.command_angular_speed_rad_s.empty();
}

/// Sum of squares of the commands' difference, where the second's are read `offset_s` later.
double command_difference(const Trajectory& first, const Trajectory& second, double offset_s) {
  Times at_s = first.time_s;
  for (double& t : at_s) t += offset_s;
  double sum = 0;
  const auto add = [&](const Times& one, const Times& other) {
    const Times there = interpolate(second.time_s, other, at_s);
    for (std::size_t i = 0; i < one.size(); ++i) sum += (one[i] - there[i]) * (one[i] - there[i]);
  };
  add(first.command_linear_speed_m_s, second.command_linear_speed_m_s);
  add(first.command_angular_speed_rad_s, second.command_angular_speed_rad_s);
  return sum;
}

}  // namespace

double command_offset_s(const Trajectory& first, const Trajectory& second) {
  if (!has_commands(first) || !has_commands(second)) return 0.0;
  double best_s = 0.0, least = command_difference(first, second, 0.0);
  const auto search = [&](double about_s, double reach_s, double step_s) {
    for (double offset_s = about_s - reach_s; offset_s <= about_s + reach_s; offset_s += step_s)
      if (const double sum = command_difference(first, second, offset_s); sum < kBetterOffset * least)
        best_s = offset_s, least = sum;
  };
  search(0.0, kLargestClockOffset_s, 0.1);
  search(best_s, 0.1, 0.01);
  return best_s;
}

Alignment align(const Run& real, const RunSignals& real_signals, const Run& simulated,
                const RunSignals& simulated_signals) {
  const double offset_s = command_offset_s(real.log, simulated.log);
  Alignment best;
  const auto consider = [&](AlignedBy by, Times real_time_s) {
    const double difference = motion_difference(real_signals, simulated_signals, real_time_s);
    if (by == AlignedBy::time || difference + kSameMotion < best.motion_difference)
      best = {by, by == AlignedBy::command ? offset_s : 0.0, difference, std::move(real_time_s)};
  };
  Times same_s = times_of(simulated_signals.time_s);
  consider(AlignedBy::time, same_s);
  for (double& t : same_s) t -= offset_s;
  if (offset_s != 0) consider(AlignedBy::command, same_s);
  const Times way = progress_of(real_signals), simulated_way = progress_of(simulated_signals);
  if (way.back() > 0 && simulated_way.back() > 0)
    consider(AlignedBy::path, interpolate(way, times_of(real_signals.time_s), simulated_way));
  return best;
}

}  // namespace joulepath
