#pragma once

#include "planner/profile.hpp"

namespace joulepath {

/// A profile from rest to rest, averaged over a window of time:
///   rate_f(t) = (s(t) - s(t - w))/w,   a_f = (rate(t) - rate(t - w))/w,   jerk_f = (a(t) - a(t - w))/w.
///
/// It covers the same distance in w more seconds; rates and accelerations are means of the given ones, and
/// its jerk is at most (largest acceleration + largest deceleration)/w. Exact: segments of constant jerk.
[[nodiscard]] Profile averaged_over(const Profile& profile, double window_s);

/// Largest |jerk| of a profile's segments.
[[nodiscard]] double largest_jerk(const Profile& profile);

/// A profile within a finite jerk limit, from rest to rest: the optimum without that limit for the time that
/// is left, averaged over a window that is just long enough, with the other limits taken back where the
/// averaging brings them above (it shifts speeds along the path). Its status is `feasible`: the bound is
/// that of the problem without the jerk limit.
[[nodiscard]] ProfileResult solve_with_jerk_limit(const ProfileRequest& request);

}  // namespace joulepath
