#include "planner/motion/motion_energy.hpp"

namespace joulepath {

MotionInstant motion_instant(const PathMotion& motion, const ProfileState& state) {
  const PathMotion::Place place = motion.laws(state.s, state.time_s);
  return {.motion = PathMotion::body_motion(place.rates, state.rate, state.acceleration), .site = place.site};
}

double drive_power_W(const PathMotion& motion, const ProfileState& state) {
  const Plant& plant = motion.plant();
  return drive_power_W(plant, energy_node(plant, motion_instant(motion, state), state.time_s));
}

double segment_energy_J(const PathMotion& motion, const Profile& profile, std::size_t k) {
  double energy_J = 0;
  integrate_profile(motion, profile, profile.time_s[k], profile.time_s[k + 1], [&](const EnergyNode& node) {
    energy_J += node.weight_s * planned_power_W(motion.plant(), node.wheels);
  });
  return energy_J;
}

double planned_energy_J(const PathMotion& motion, const Profile& profile) {
  double sum_J = motion.plant().robot.power.standby_W * profile.duration_s();
  for (std::size_t k = 0; k + 1 < profile.s.size(); ++k) sum_J += segment_energy_J(motion, profile, k);
  return sum_J;
}

EnergyByCause energy_between(const PathMotion& motion, const Profile& profile, double from_s, double to_s) {
  EnergySum sum(motion.plant());
  integrate_profile(motion, profile, from_s, to_s, [&](const EnergyNode& node) { sum.add(node); });
  EnergyByCause energy = sum.by_cause();
  const double waited_s = std::max(0.0, to_s - std::max(from_s, profile.time_s.back()));
  energy.standby_J += waited_s * motion.plant().robot.power.standby_W;
  return energy;
}

EnergyByCause energy_by_cause(const PathMotion& motion, const Profile& profile) {
  return energy_between(motion, profile, 0.0, profile.duration_s());
}

}  // namespace joulepath
