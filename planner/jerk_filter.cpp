#include "planner/jerk_filter.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath {
namespace {

/// Acceleration of the given profile at a time that is inside of one of its segments; 0 outside of it.
double acceleration_at(const Profile& profile, double time_s) {
  if (time_s <= 0 || time_s >= profile.time_s.back()) return 0.0;
  return profile.at_time(time_s).acceleration;
}

double rate_at(const Profile& profile, double time_s) {
  if (time_s <= 0 || time_s >= profile.time_s.back()) return 0.0;
  return profile.at_time(time_s).rate;
}

}  // namespace

Profile averaged_over(const Profile& profile, double window_s) {
  std::vector<double> times = profile.time_s;
  for (double time_s : profile.time_s) times.push_back(time_s + window_s);
  std::sort(times.begin(), times.end());
  const double shortest_s = 1e-10 * times.back();
  Profile mean{.time_s = {0.0}, .s = {0.0}, .rate = {0.0}};
  for (double end_s : times) {
    const double start_s = mean.time_s.back(), t = end_s - start_s;
    if (t < shortest_s) continue;
    const double inside_s = 0.5 * (start_s + end_s), u = mean.rate.back();
    const double a = (rate_at(profile, start_s) - rate_at(profile, start_s - window_s)) / window_s;
    const double j =
        (acceleration_at(profile, inside_s) - acceleration_at(profile, inside_s - window_s)) / window_s;
    mean.acceleration.push_back(a);
    mean.jerk.push_back(j);
    mean.time_s.push_back(end_s);
    mean.s.push_back(mean.s.back() + t * (u + t * (a / 2 + t * j / 6)));
    mean.rate.push_back(std::max(0.0, u + t * (a + t * j / 2)));
  }
  // Rounding of the sums, some 1e-13 of the length: the ends are known.
  const double scale = profile.s.back() / mean.s.back();
  for (double& s : mean.s) s *= scale;
  mean.rate.back() = 0.0;
  return mean;
}

double largest_jerk(const Profile& profile) {
  double most = 0;
  for (double jerk : profile.jerk) most = std::max(most, std::abs(jerk));
  return most;
}

}  // namespace joulepath
