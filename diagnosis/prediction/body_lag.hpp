#pragma once

#include <Eigen/Core>

#include "model/operating_point.hpp"

namespace joulepath {

/// A quantity that follows another one with a lag, and its rate, at each sample.
struct Lagged {
  Eigen::VectorXd value{}, rate{};
};

/// How far the body's speed (m/s) and yaw rate (rad/s) fall short of those that its wheels' encoders tell.
struct BodyLag {
  Lagged along{}, turn{};

  [[nodiscard]] bool empty() const { return along.value.size() == 0; }
  BodyLag& operator+=(const BodyLag& other);
  BodyLag& operator*=(double factor);

  /// Of the body, at a sample in which the wheels move as `wheels` says.
  [[nodiscard]] BodyMotion<double> body_motion(BodyMotion<double> wheels, Eigen::Index j) const;
  /// The wheels' own inertia follows the wheels, not the body.
  void spin_wheels(const Plant& plant, const Site& site, Eigen::Index j,
                   Sided<WheelState<double>>& state) const;
};

}  // namespace joulepath
