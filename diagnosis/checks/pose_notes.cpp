#include "diagnosis/checks/pose_notes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "model/kinematics.hpp"

namespace joulepath {
namespace {

using Samples = std::vector<double>;

constexpr std::size_t kLeastSteps = 100;
/// Correlation of neighbors among the second differences: -2/3 of white noise, positive of a motion that is
/// sampled well.
constexpr double kMostlyNoise = -0.4;
constexpr double kSameNoise = 0.9;  ///< correlation of the pose's second differences with the wheels'
constexpr double kSameWay =
    0.01;  ///< of all that the wheels drove: a localization has not corrected the pose

Samples second_differences(const Samples& values) {
  Samples differences;
  for (std::size_t i = 2; i < values.size(); ++i)
    differences.push_back(values[i] - 2 * values[i - 1] + values[i - 2]);
  return differences;
}

/// Of a[i] with b[i + lag], about zero.
double correlation(const Samples& a, const Samples& b, std::size_t lag = 0) {
  double aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i + lag < std::min(a.size(), b.size()); ++i)
    aa += a[i] * a[i], bb += b[i + lag] * b[i + lag], ab += a[i] * b[i + lag];
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0.0;
}

/// A rate by the wheels at the samples, and the pose's mean rate over each step between them.
struct Rates {
  Samples wheels{}, pose{};
  double apart{}, farthest_apart{};  ///< of what the pose's rate and the wheels' add up to
  double driven{}, longest_step{};   ///< by the wheels, in either direction

  void add_step(double before, double after, double change, double step_s) {
    wheels.push_back(after);
    pose.push_back(change / step_s);
    apart += change - 0.5 * (before + after) * step_s;
    farthest_apart = std::max(farthest_apart, std::abs(apart));
    const double step = 0.5 * (std::abs(before) + std::abs(after)) * step_s;
    driven += step;
    longest_step = std::max(longest_step, step);
  }

  /// Whether no more than where in a step the rate was taken tells pose and wheels apart.
  bool share_way() const { return farthest_apart <= kSameWay * driven + longest_step; }

  /// Whether the noise of the wheels is that of the pose, which was summed up from their rate at the end, at
  /// the start or in the middle of each step.
  bool share_noise() const {
    if (pose.size() < kLeastSteps || !share_way()) return false;
    const Samples of_pose = second_differences(pose), all = second_differences(wheels);
    if (correlation(all, all, 1) > kMostlyNoise) return false;
    Samples starts(all.begin(), all.end() - 1), ends(all.begin() + 1, all.end());
    Samples middles(starts.size());
    std::ranges::transform(starts, ends, middles.begin(), [](double a, double b) { return 0.5 * (a + b); });
    return std::ranges::any_of(std::to_array({&starts, &middles, &ends}),
                               [&](Samples* noise) { return correlation(*noise, of_pose) > kSameNoise; });
  }
};

/// Yaw rates, and speeds along the heading; empty where channels are absent.
std::array<Rates, 2> rates_of(const Run& run, const Geometry& geometry) {
  const Trajectory& log = run.log;
  const std::size_t n = log.size();
  const auto has = [n](const Samples& channel) { return n > 1 && channel.size() == n; };
  const Samples &left = log.wheel_speed_rad_s.left, &right = log.wheel_speed_rad_s.right;
  std::array<Rates, 2> rates;
  if (!has(left) || !has(right) || !has(log.heading_rad)) return rates;
  auto& [turning, driving] = rates;
  const bool placed = has(log.position_x_m) && has(log.position_y_m);
  const auto twist_at = [&](std::size_t i) { return body_twist<double>(geometry, {left[i], right[i]}); };
  turning.wheels.push_back(twist_at(0).yaw_rate_rad_s);
  driving.wheels.push_back(twist_at(0).speed_m_s);
  for (std::size_t i = 1; i < n; ++i) {
    const double step_s = log.time_s[i] - log.time_s[i - 1];
    const double turned = std::remainder(log.heading_rad[i] - log.heading_rad[i - 1], 2 * std::numbers::pi);
    const Twist<double> before = twist_at(i - 1), after = twist_at(i);
    if (!(step_s > 0) || !std::isfinite(turned + before.yaw_rate_rad_s + after.yaw_rate_rad_s)) continue;
    turning.add_step(before.yaw_rate_rad_s, after.yaw_rate_rad_s, turned, step_s);
    if (!placed) continue;
    const double middle_rad = log.heading_rad[i - 1] + 0.5 * turned;
    const double along_m = (log.position_x_m[i] - log.position_x_m[i - 1]) * std::cos(middle_rad) +
                           (log.position_y_m[i] - log.position_y_m[i - 1]) * std::sin(middle_rad);
    if (std::isfinite(along_m)) driving.add_step(before.speed_m_s, after.speed_m_s, along_m, step_s);
  }
  return rates;
}

}  // namespace

std::vector<std::string> pose_notes(const Dataset& dataset) {
  for (const Run& run : dataset.runs) {
    const auto [turning, driving] = rates_of(run, dataset.robot.geometry);
    const bool heading = turning.share_noise(), position = driving.share_noise();
    if (!heading && !position) continue;
    const std::string what = !position ? "heading_rad repeats"
                             : heading ? "position_x_m, position_y_m and heading_rad repeat"
                                       : "position_x_m and position_y_m repeat";
    return {run.name + ": " + what +
            " the noise of the wheels: is it their odometry? It shows no slip and no wrong radius or track; "
            "name the pose of a localization, or leave the pose out"};
  }
  return {};
}

}  // namespace joulepath
