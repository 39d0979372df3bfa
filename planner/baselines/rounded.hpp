#pragma once

#include "planner/baselines/baseline.hpp"

namespace joulepath {

/// Whether a jerk limit rounds the corners of a request's trapezoids.
[[nodiscard]] bool is_rounded(const ProfileRequest& request);

/// The two trapezoids (baseline.hpp) under a jerk limit: held below the local limits of the path, then
/// averaged over the shortest window that keeps the jerk limit. The limits are first lowered to their least
/// value within the window, so that averages of the rate keep them. From rest to rest only.
[[nodiscard]] BaselineResult rounded_max_acceleration(const ProfileRequest& request, const char* name,
                                                      double duration_s);
[[nodiscard]] BaselineResult rounded_best_tuned(const ProfileRequest& request, const char* name,
                                                double duration_s);

}  // namespace joulepath
