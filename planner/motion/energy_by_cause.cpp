#include <algorithm>
#include <array>
#include <cmath>

#include "planner/motion/path_motion.hpp"
#include "planner/motion/segment_energy.hpp"

namespace joulepath {
namespace {

PowerByCause power_at(const PathMotion& motion, const ProfileState& state) {
  const PathMotion::Place place = motion.place(state.s, state.time_s);
  return power_by_cause(motion.plant(), PathMotion::body_motion(place.rates, state.rate, state.acceleration),
                        place.site);
}

/// Signs of the two motors' power decide what is recovered: a kink between differing signs.
int power_signs(const PathMotion& motion, const ProfileState& state) {
  const PathMotion::Place place = motion.place(state.s, state.time_s);
  const Sided<WheelState<double>> wheels = operating_point(
      motion.plant(), PathMotion::body_motion(place.rates, state.rate, state.acceleration), place.site);
  const double left_W = wheels.left.power_W, right_W = wheels.right.power_W;
  return (left_W > 0) + 2 * (right_W > 0) + 4 * (left_W + right_W > 0);
}

void integrate(const PathMotion& motion, const Profile& profile, double from_s, double to_s, int depth,
               EnergyByCause& sum) {
  const double length = to_s - from_s;
  const double edge = 1e-9 * length;
  if (depth > 0 && power_signs(motion, profile.at_time(from_s + edge)) !=
                       power_signs(motion, profile.at_time(to_s - edge))) {
    const double middle_s = 0.5 * (from_s + to_s);
    integrate(motion, profile, from_s, middle_s, depth - 1, sum);
    integrate(motion, profile, middle_s, to_s, depth - 1, sum);
    return;
  }
  constexpr std::array<double, 3> fractions{0.1127016653792583, 0.5, 0.8872983346207417};
  constexpr std::array<double, 3> weights{5.0 / 18, 8.0 / 18, 5.0 / 18};
  for (std::size_t i = 0; i < 3; ++i)
    sum.add(motion.plant(), power_at(motion, profile.at_time(from_s + fractions[i] * length)),
            weights[i] * length);
}

}  // namespace

EnergyByCause energy_between(const PathMotion& motion, const Profile& profile, double from_s, double to_s) {
  constexpr int kHalvings = 12;
  EnergyByCause sum;
  const std::vector<double>& time_s = profile.time_s;
  const auto after = std::upper_bound(time_s.begin(), time_s.end(), from_s) - time_s.begin();
  for (auto k = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - 1, 0)); k + 1 < time_s.size();
       ++k) {
    const double begin_s = std::max(from_s, time_s[k]), end_s = std::min(to_s, time_s[k + 1]);
    if (end_s > begin_s) integrate(motion, profile, begin_s, end_s, kHalvings, sum);
    if (time_s[k + 1] >= to_s) break;
  }
  const double waited_s = std::max(0.0, to_s - std::max(from_s, time_s.back()));
  sum.standby_J += waited_s * motion.plant().robot.power.standby_W;
  return sum;
}

EnergyByCause energy_by_cause(const PathMotion& motion, const Profile& profile) {
  return energy_between(motion, profile, 0.0, profile.duration_s());
}

}  // namespace joulepath
