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

/// Sums of products of a[i] and b[i + lag].
struct Products {
  Products(const Samples& a, const Samples& b, std::size_t lag = 0) {
    for (std::size_t i = 0; i + lag < std::min(a.size(), b.size()); ++i, ++count)
      aa += a[i] * a[i], bb += b[i + lag] * b[i + lag], ab += a[i] * b[i + lag];
  }

  double correlation() const { return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0.0; }
  /// Of b by a, and its relative standard error.
  double slope() const { return ab / aa; }
  double slope_error() const {
    const double r2 = correlation() * correlation();
    return std::sqrt(std::max(0.0, 1 - r2) / (r2 * static_cast<double>(count)));
  }

  double aa{}, bb{}, ab{};
  std::size_t count{};
};

/// A rate by the wheels at the samples, and the pose's mean rate over each step between them.
struct Rates {
  Samples wheels{}, pose{};
  Samples wheel_steps{}, pose_steps{};  ///< rates times time

  void add_step(double before, double after, double change, double step_s) {
    wheels.push_back(after);
    pose.push_back(change / step_s);
    wheel_steps.push_back(0.5 * (before + after) * step_s);
    pose_steps.push_back(change);
  }

  /// Whether the pose goes the way of wheels of another size: no more than where in a step the rate was
  /// taken, and the doubt of that size, tells them apart, nor how large the wheels are by the way.
  bool share_way(double size, double doubt) const {
    double apart = 0, farthest_apart = 0, driven = 0, longest_step = 0, farthest = 0;
    Samples by_wheels{0.0}, by_pose{0.0};
    for (std::size_t i = 0; i < pose_steps.size(); ++i) {
      by_wheels.push_back(by_wheels.back() + wheel_steps[i]);
      by_pose.push_back(by_pose.back() + pose_steps[i]);
      farthest = std::max(farthest, std::abs(by_wheels.back()));
      apart += pose_steps[i] - size * wheel_steps[i];
      farthest_apart = std::max(farthest_apart, std::abs(apart));
      driven += std::abs(wheel_steps[i]);
      longest_step = std::max(longest_step, std::abs(wheel_steps[i]));
    }
    const double of_way = Products(by_wheels, by_pose).slope(), same = kSameWay + doubt;
    return farthest_apart <= same * driven + longest_step &&
           std::abs(of_way - size) * farthest <= same * farthest + longest_step;
  }

  /// Whether the noise of the wheels is that of the pose, which was summed up from their rate at the end, at
  /// the start or in the middle of each step, with whatever radius and track.
  bool share_noise() const {
    if (pose.size() < kLeastSteps) return false;
    const Samples of_pose = second_differences(pose), all = second_differences(wheels);
    if (Products(all, all, 1).correlation() > kMostlyNoise) return false;
    Samples starts(all.begin(), all.end() - 1), ends(all.begin() + 1, all.end());
    Samples middles(starts.size());
    std::ranges::transform(starts, ends, middles.begin(), [](double a, double b) { return 0.5 * (a + b); });
    return std::ranges::any_of(std::to_array({&starts, &middles, &ends}), [&](Samples* noise) {
      constexpr double kErrors = 3;
      const Products products(*noise, of_pose);
      return products.correlation() > kSameNoise &&
             share_way(products.slope(), kErrors * products.slope_error());
    });
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
