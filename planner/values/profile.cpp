
#include "planner/values/profile.hpp"

#include <algorithm>
#include <cmath>

#include "model/assert.hpp"

namespace joulepath {
namespace {

std::size_t segment_of(const std::vector<double>& nodes, double value) {
  const auto after = std::upper_bound(nodes.begin(), nodes.end(), value);
  const auto index = after - nodes.begin() - 1;
  return static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(index, 0, static_cast<std::ptrdiff_t>(nodes.size()) - 2));
}

ProfileState state_in(const Profile& profile, std::size_t k, double tau) {
  const double u = profile.rate[k], a = profile.acceleration[k], j = profile.jerk[k];
  return {.time_s = profile.time_s[k] + tau,
          .s = profile.s[k] + tau * (u + tau * (a / 2 + tau * j / 6)),
          .rate = std::max(0.0, u + tau * (a + tau * j / 2)),
          .acceleration = a + tau * j};
}

}  // namespace

ProfileState Profile::at_time(double t) const {
  JOULEPATH_ASSERT(time_s.size() >= 2, "a profile needs a segment");
  if (t >= time_s.back()) {
    const bool waits = t > time_s.back() && rate.back() <= 1e-9;
    return {t, s.back(), rate.back(),
            waits ? 0.0 : acceleration.back() + jerk.back() * (time_s.back() - time_s[time_s.size() - 2])};
  }
  const std::size_t k = segment_of(time_s, t);
  return state_in(*this, k, std::max(0.0, t - time_s[k]));
}

ProfileState Profile::at_s(double place) const {
  JOULEPATH_ASSERT(time_s.size() >= 2, "a profile needs a segment");
  const std::size_t k = segment_of(s, place);
  const double length = std::clamp(place, s.front(), s.back()) - s[k];
  const double u = rate[k], a = acceleration[k], duration = time_s[k + 1] - time_s[k];
  if (length <= 0) return state_in(*this, k, 0.0);
  if (jerk[k] == 0.0) {
    const double root = std::sqrt(std::max(0.0, u * u + 2 * a * length));
    return state_in(*this, k, std::min(duration, 2 * length / (u + root)));
  }
  double low = 0, high = duration;  // s grows with time: bisection is safe, 60 halvings exact
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (state_in(*this, k, middle).s - s[k] < length ? low : high) = middle;
  }
  return state_in(*this, k, high);
}

Profile Profile::divided(const std::vector<double>& at, double longest) const {
  Profile fine{.time_s = {time_s.front()}, .s = {s.front()}, .rate = {rate.front()}, .wait_s = wait_s};
  for (std::size_t k = 0; k + 1 < time_s.size(); ++k) {
    const double ds = s[k + 1] - s[k], dt = time_s[k + 1] - time_s[k];
    std::vector<double> times;
    const int parts = std::max(1, static_cast<int>(std::ceil(ds / longest)));
    for (int i = 1; i < parts; ++i) times.push_back(at_s(s[k] + ds * i / parts).time_s);
    for (double place : at)
      if (place > s[k] + 1e-9 * ds && place < s[k + 1] - 1e-9 * ds) times.push_back(at_s(place).time_s);
    std::sort(times.begin(), times.end());
    times.push_back(time_s[k + 1]);
    for (double time : times) {
      const double last = fine.time_s.back();
      const bool ends = time == time_s[k + 1];
      if (!ends && (time <= last + 1e-9 * dt || time >= time_s[k + 1] - 1e-9 * dt)) continue;
      fine.acceleration.push_back(acceleration[k] + jerk[k] * (last - time_s[k]));
      fine.jerk.push_back(jerk[k]);
      const ProfileState state = state_in(*this, k, time - time_s[k]);
      fine.time_s.push_back(time);
      fine.s.push_back(ends ? s[k + 1] : state.s);
      fine.rate.push_back(ends ? rate[k + 1] : state.rate);
    }
  }
  return fine;
}

Profile profile_from_squares(const std::vector<double>& s, const std::vector<double>& b) {
  JOULEPATH_ASSERT(s.size() == b.size() && s.size() >= 2, "one square of the rate per node");
  Profile profile{.time_s = {0.0}, .s = s};
  for (double square : b) profile.rate.push_back(std::sqrt(std::max(0.0, square)));
  for (std::size_t k = 0; k + 1 < s.size(); ++k) {
    const double ds = s[k + 1] - s[k];
    profile.acceleration.push_back((b[k + 1] - b[k]) / (2 * ds));
    profile.jerk.push_back(0.0);
    profile.time_s.push_back(profile.time_s.back() + 2 * ds / (profile.rate[k] + profile.rate[k + 1]));
  }
  return profile;
}

}  // namespace joulepath
