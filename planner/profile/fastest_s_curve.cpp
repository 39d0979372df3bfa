#include "planner/profile/fastest_s_curve.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace joulepath {
namespace {

/// Durations (s) of increasing and of constant acceleration between rest and a rate.
std::pair<double, double> ramp_times_s(double rate, double acceleration, double jerk) {
  if (rate * jerk >= acceleration * acceleration)
    return {acceleration / jerk, rate / acceleration - acceleration / jerk};
  return {std::sqrt(rate / jerk), 0.0};
}

/// Length of both ramps, which are mirror images: mean rate times their duration.
double ramps_length(double rate, double acceleration, double jerk) {
  const auto [bend_s, steady_s] = ramp_times_s(rate, acceleration, jerk);
  return rate * (2 * bend_s + steady_s);
}

void append(Profile& profile, double duration_s, double jerk) {
  const double t = duration_s;
  if (!(t > 0)) return;
  const bool first = profile.acceleration.empty();
  const double before_s = first ? 0.0 : profile.time_s.back() - profile.time_s[profile.time_s.size() - 2];
  const double a = first ? 0.0 : profile.acceleration.back() + profile.jerk.back() * before_s;
  const double u = profile.rate.back();
  profile.acceleration.push_back(a);
  profile.jerk.push_back(jerk);
  profile.time_s.push_back(profile.time_s.back() + t);
  profile.s.push_back(profile.s.back() + t * (u + t * (a / 2 + t * jerk / 6)));
  profile.rate.push_back(std::max(0.0, u + t * (a + t * jerk / 2)));
}

}  // namespace

Profile fastest_s_curve(double length, double rate, double acceleration, double jerk) {
  constexpr int kHalvings = 200;
  double peak = rate;
  if (!(ramps_length(rate, acceleration, jerk) <= length)) {
    double low = 0, high = std::isfinite(rate) ? rate : std::sqrt(length * acceleration) + 1e-9;
    for (int i = 0; i < kHalvings; ++i) {
      peak = 0.5 * (low + high);
      (ramps_length(peak, acceleration, jerk) < length ? low : high) = peak;
    }
  }
  const auto [bend_s, steady_s] = ramp_times_s(peak, acceleration, jerk);
  Profile profile{.time_s = {0.0}, .s = {0.0}, .rate = {0.0}};
  append(profile, bend_s, jerk);
  append(profile, steady_s, 0);
  append(profile, bend_s, -jerk);
  append(profile, std::max(0.0, length - ramps_length(peak, acceleration, jerk)) / peak, 0);
  append(profile, bend_s, -jerk);
  append(profile, steady_s, 0);
  append(profile, bend_s, jerk);
  profile.s.back() = length;
  profile.rate.back() = 0;
  return profile;
}

}  // namespace joulepath
