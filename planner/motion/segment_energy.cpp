#include "planner/motion/segment_energy.hpp"

#include <array>

namespace joulepath {
namespace {

constexpr std::array<double, 3> kFractions{0.1127016653792583, 0.5, 0.8872983346207417};
constexpr std::array<double, 3> kWeights{5.0 / 18, 8.0 / 18, 5.0 / 18};

Sided<double> motor_powers_W(const PathMotion& motion, const ProfileState& state) {
  const PathMotion::Place place = motion.place(state.s, state.time_s);
  const Sided<WheelState<double>> wheels = operating_point(
      motion.plant(), PathMotion::body_motion(place.rates, state.rate, state.acceleration), place.site);
  return {wheels.left.power_W, wheels.right.power_W};
}

int signs(const Sided<double>& power_W) {
  return (power_W.left > 0) + 2 * (power_W.right > 0) + 4 * (power_W.left + power_W.right > 0);
}

double integral_J(const PathMotion& motion, const Profile& profile, double from_s, double to_s, int depth) {
  const double length_s = to_s - from_s, edge_s = 1e-9 * length_s;
  const PowerSupply& supply = motion.plant().robot.power;
  if (depth > 0 && supply.regeneration_efficiency < 1 &&
      signs(motor_powers_W(motion, profile.at_time(from_s + edge_s))) !=
          signs(motor_powers_W(motion, profile.at_time(to_s - edge_s)))) {
    const double middle_s = 0.5 * (from_s + to_s);
    return integral_J(motion, profile, from_s, middle_s, depth - 1) +
           integral_J(motion, profile, middle_s, to_s, depth - 1);
  }
  double sum_J = 0;
  for (std::size_t i = 0; i < kFractions.size(); ++i)
    sum_J +=
        kWeights[i] * length_s * drive_power_W(motion, profile.at_time(from_s + kFractions[i] * length_s));
  return sum_J;
}

}  // namespace

double drive_power_W(const PathMotion& motion, const ProfileState& state) {
  return supply_power_W(motion.plant().robot.power, motor_powers_W(motion, state));
}

double segment_energy_J(const PathMotion& motion, const Profile& profile, std::size_t k) {
  constexpr int kHalvings = 8;
  return integral_J(motion, profile, profile.time_s[k], profile.time_s[k + 1], kHalvings);
}

}  // namespace joulepath
