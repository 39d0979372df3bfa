#include "diagnosis/prediction/body_lag.hpp"

#include "diagnosis/prediction/added_torque.hpp"

namespace joulepath {

BodyLag& BodyLag::operator+=(const BodyLag& other) {
  if (other.empty()) return *this;
  if (empty()) return *this = other;
  along.value += other.along.value, along.rate += other.along.rate;
  turn.value += other.turn.value, turn.rate += other.turn.rate;
  return *this;
}

BodyLag& BodyLag::operator*=(double factor) {
  for (Lagged* part : {&along, &turn}) part->value *= factor, part->rate *= factor;
  return *this;
}

BodyMotion<double> BodyLag::body_motion(BodyMotion<double> wheels, Eigen::Index j) const {
  wheels.speed_m_s -= along.value[j];
  wheels.acceleration_m_s2 -= along.rate[j];
  wheels.yaw_rate_rad_s -= turn.value[j];
  wheels.yaw_acceleration_rad_s2 -= turn.rate[j];
  return wheels;
}

void BodyLag::spin_wheels(const Plant& plant, const Site& site, Eigen::Index j,
                          Sided<WheelState<double>>& state) const {
  const Robot& robot = plant.robot;
  const Sided<double> ahead_rad_s2 = wheel_speeds_rad_s(robot.geometry, along.rate[j], turn.rate[j]);
  for (const Side side : kSides)
    add_torque(plant, site, side, robot.inertia.wheel_axle_inertia_kg_m2 * ahead_rad_s2[side], state[side]);
}

}  // namespace joulepath
