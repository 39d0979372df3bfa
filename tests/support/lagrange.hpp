#pragma once

#include "tests/support/state_space.hpp"

namespace joulepath::testing {

using FullCoordinates = Eigen::Matrix<double, 5, 1>;  // x, y, phi, q_left, q_right: before any constraint

/// Kinetic energy written body by body, independent of the model: each mass at its place, its velocity
/// by the chain rule on its position.
[[nodiscard]] double lagrangian_J(const Robot& robot, double payload_kg, const FullCoordinates& q,
                                  const FullCoordinates& rate);

/// q' of wheel speeds, straight from [P1, Eqs. (1)-(3)].
[[nodiscard]] FullCoordinates rolling(const Geometry& geometry, double phi, const WheelVector& eta);

/// Torques on the wheels that a motion needs for its inertia: d/dt dK/dq' - dK/dq, projected on the
/// motions that rolling allows.
[[nodiscard]] WheelVector lagrange_torque_Nm(const Robot& robot, double payload_kg, double phi,
                                             const WheelVector& eta, const WheelVector& acceleration);

}  // namespace joulepath::testing
