#pragma once

#include <functional>

#include "planner/baselines/baseline.hpp"

namespace joulepath {

/// A profile from rest to rest whose shape is given: share of the distance and relative rate by share of
/// the time, sampled at nodes of constant acceleration and scaled to take `duration_s` exactly.
struct TimeShape {
  std::function<double(double)> distance_share{};  ///< f(0) = 0, f(1) = 1
  std::function<double(double)> rate{};            ///< f', times distance/duration is the rate
};

[[nodiscard]] Profile shaped_profile(const TimeShape& shape, double length, double duration_s);

/// A profile made of stretches of constant jerk, from rest.
struct JerkPiece {
  double duration_s{};
  double jerk{};
};
[[nodiscard]] Profile jerk_profile(const std::vector<JerkPiece>& pieces, double start_acceleration = 0.0);

}  // namespace joulepath
