#pragma once

#include <algorithm>

#include "model/power.hpp"
#include "model/quadrature.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/values/profile.hpp"

namespace joulepath {

/// The input of the power model at a state of a profile.
[[nodiscard]] MotionInstant motion_instant(const PathMotion& motion, const ProfileState& state);

/// Power (W) that the drives take from the supply at a state, without standby.
[[nodiscard]] double drive_power_W(const PathMotion& motion, const ProfileState& state);

/// The same for the states of both wheels as a planner counts it: with what the currents cost beside it
/// (Plant::heat_price_ohm).
[[nodiscard]] inline double planned_power_W(const Plant& plant, const Sided<WheelState<double>>& wheels) {
  const auto cost_W = [&](Side side) {
    return wheels[side].power_W +
           plant.heat_price_ohm[side] * wheels[side].current_A * wheels[side].current_A;
  };
  return supply_power_W(plant.robot.power, {cost_W(Side::left), cost_W(Side::right)});
}

/// Calls visit(node) for the nodes of the energy integral between two instants of a profile, segment by
/// segment. Waiting at the profile's end has no nodes.
template <class Visit>
void integrate_profile(const PathMotion& motion, const Profile& profile, double from_s, double to_s,
                       Visit&& visit) {
  const std::vector<double>& time_s = profile.time_s;
  const auto after = std::upper_bound(time_s.begin(), time_s.end(), from_s) - time_s.begin();
  const auto instant_at = [&](double at_s) { return motion_instant(motion, profile.at_time(at_s)); };
  for (auto k = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - 1, 0)); k + 1 < time_s.size();
       ++k) {
    const double begin_s = std::max(from_s, time_s[k]), end_s = std::min(to_s, time_s[k + 1]);
    if (end_s > begin_s) integrate(motion.plant(), instant_at, begin_s, end_s, visit);
    if (time_s[k + 1] >= to_s) break;
  }
}

/// Energy (J) at the battery's terminals over segment k of a profile, without standby, as a planner counts
/// it.
[[nodiscard]] double segment_energy_J(const PathMotion& motion, const Profile& profile, std::size_t k);

/// The same of a whole profile, with standby.
[[nodiscard]] double planned_energy_J(const PathMotion& motion, const Profile& profile);

/// Joules by cause between two instants of a profile, waiting at its end included. Consecutive intervals add
/// up to the whole.
[[nodiscard]] EnergyByCause energy_between(const PathMotion& motion, const Profile& profile, double from_s,
                                           double to_s);

/// Joules by cause of a whole profile.
[[nodiscard]] EnergyByCause energy_by_cause(const PathMotion& motion, const Profile& profile);

}  // namespace joulepath
