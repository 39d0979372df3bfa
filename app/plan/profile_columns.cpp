#include "app/plan/profile_columns.hpp"

#include "planner/motion/motion_energy.hpp"

namespace joulepath {

report::Columns profile_columns(const std::vector<const ProfileRequest*>& requests,
                                const std::vector<Profile>& profiles, int samples) {
  report::Columns columns;
  double start_s = 0, start_m = 0, energy_J = 0;
  for (std::size_t i = 0; i < profiles.size() && i < requests.size(); ++i) {
    const Profile& profile = profiles[i];
    const PathMotion motion = path_motion(*requests[i]);
    const bool turn = is_turn(requests[i]->piece);
    const double standby_W = requests[i]->plant.robot.power.standby_W;
    const auto time_s = [&](int k) { return profile.duration_s() * k / samples; };
    for (int k = 0; k <= samples; ++k) {
      const ProfileState state = profile.at_time(time_s(k));
      const PathRates rates = motion.rates(state.s);
      columns["time_s"].push_back(start_s + state.time_s);
      columns["arc_length_m"].push_back(start_m + (turn ? 0.0 : state.s));
      columns["linear_speed_m_s"].push_back(rates.along * state.rate);
      columns["linear_acceleration_m_s2"].push_back(rates.along * state.acceleration);
      columns["angular_speed_rad_s"].push_back(rates.turn * state.rate);
      if (k > 0) energy_J += energy_between(motion, profile, time_s(k - 1), time_s(k)).total_J();
      columns["battery_power_W"].push_back(drive_power_W(motion, state) + standby_W);
      columns["energy_J"].push_back(energy_J);
    }
    start_s += profile.duration_s();
    if (!turn) start_m += motion.length();
  }
  return columns;
}

}  // namespace joulepath
