#include "tests/support/lagrange.hpp"

#include <cmath>

namespace joulepath::testing {

double lagrangian_J(const Robot& robot, double payload_kg, const FullCoordinates& q,
                    const FullCoordinates& rate) {
  const double phi = q[2];
  const auto body_J = [&](double mass_kg, double forward_m, double sideways_m, double yaw_inertia_kg_m2) {
    const double x_rate = rate[0] - (forward_m * std::sin(phi) + sideways_m * std::cos(phi)) * rate[2];
    const double y_rate = rate[1] + (forward_m * std::cos(phi) - sideways_m * std::sin(phi)) * rate[2];
    return 0.5 * mass_kg * (x_rate * x_rate + y_rate * y_rate) + 0.5 * yaw_inertia_kg_m2 * rate[2] * rate[2];
  };
  const Inertia& inertia = robot.inertia;
  const double l = robot.geometry.half_track_m;
  double energy_J = body_J(inertia.chassis_mass_kg, robot.geometry.center_of_mass_offset_m, 0,
                           inertia.chassis_yaw_inertia_kg_m2);
  energy_J +=
      body_J(payload_kg, robot.payload_offset_or_default_m(), 0, inertia.payload_yaw_inertia_m2 * payload_kg);
  energy_J += body_J(inertia.wheel_mass_kg, 0, l, inertia.wheel_diameter_inertia_kg_m2);
  energy_J += body_J(inertia.wheel_mass_kg, 0, -l, inertia.wheel_diameter_inertia_kg_m2);
  return energy_J + 0.5 * inertia.wheel_axle_inertia_kg_m2 * (rate[3] * rate[3] + rate[4] * rate[4]);
}

FullCoordinates rolling(const Geometry& geometry, double phi, const WheelVector& eta) {
  const double left_m_s = geometry.wheel_radius_m.left * eta[0];
  const double right_m_s = geometry.wheel_radius_m.right * eta[1];
  const double v = (left_m_s + right_m_s) / 2;
  FullCoordinates rate;
  rate << v * std::cos(phi), v * std::sin(phi), (right_m_s - left_m_s) / (2 * geometry.half_track_m), eta[0],
      eta[1];
  return rate;
}

namespace {

/// dK/dq' by central differences (exact: K is quadratic in q').
FullCoordinates momentum(const Robot& robot, double payload_kg, const FullCoordinates& q,
                         const FullCoordinates& rate) {
  FullCoordinates p;
  for (int i = 0; i < 5; ++i) {
    FullCoordinates step = FullCoordinates::Zero();
    step[i] = 0.5;
    p[i] = lagrangian_J(robot, payload_kg, q, rate + step) - lagrangian_J(robot, payload_kg, q, rate - step);
  }
  return p;
}

}  // namespace

WheelVector lagrange_torque_Nm(const Robot& robot, double payload_kg, double phi, const WheelVector& eta,
                               const WheelVector& acceleration) {
  const double h = 1e-5;
  FullCoordinates q = FullCoordinates::Zero();
  q[2] = phi;
  const FullCoordinates rate = rolling(robot.geometry, phi, eta);
  const auto momentum_at = [&](double t) {
    const FullCoordinates place = q + t * rate;
    const WheelVector speed = eta + t * acceleration;
    return momentum(robot, payload_kg, place, rolling(robot.geometry, place[2], speed));
  };
  FullCoordinates force = (momentum_at(h) - momentum_at(-h)) / (2 * h);
  for (int i = 0; i < 5; ++i) {
    FullCoordinates step = FullCoordinates::Zero();
    step[i] = h;
    force[i] -=
        (lagrangian_J(robot, payload_kg, q + step, rate) - lagrangian_J(robot, payload_kg, q - step, rate)) /
        (2 * h);
  }
  return {rolling(robot.geometry, phi, {1, 0}).dot(force), rolling(robot.geometry, phi, {0, 1}).dot(force)};
}

}  // namespace joulepath::testing
