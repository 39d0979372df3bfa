#pragma once

#include <functional>

#include "planner/baselines/baseline.hpp"

namespace joulepath {

/// A profile made of stretches of constant jerk, from rest.
struct JerkPiece {
  double duration_s{};
  double jerk{};
};
[[nodiscard]] Profile jerk_profile(const std::vector<JerkPiece>& pieces, double start_acceleration = 0.0);

/// A profile from rest to rest, given by its acceleration over a unit of time for a unit of distance. Sampled
/// at equal times; acceleration is linear between the samples and has no jumps.
[[nodiscard]] Profile shaped_profile(const std::function<double(double)>& acceleration, double length,
                                     double duration_s);

}  // namespace joulepath
