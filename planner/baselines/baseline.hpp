#pragma once

#include <functional>
#include <vector>

#include "planner/values/baseline_result.hpp"
#include "planner/values/profile_request.hpp"

namespace joulepath {

/// The two trapezoids that every plan is compared with, for `duration_s` in all (waiting counts).
[[nodiscard]] BaselineResult trapezoid_max_acceleration(const ProfileRequest& request, double duration_s);
[[nodiscard]] BaselineResult trapezoid_best_tuned(const ProfileRequest& request, double duration_s);

/// A family of classic profiles: its member for a request that takes a time.
using Baseline = std::function<BaselineResult(const ProfileRequest& request, double duration_s)>;

/// All of them, in the order of reports.
[[nodiscard]] const std::vector<Baseline>& baselines();
[[nodiscard]] std::vector<BaselineResult> all_baselines(const ProfileRequest& request, double duration_s);

/// A baseline at a time, or, where none makes that (no shape keeps a very tight time on a curved piece), one
/// at a later time, up to 1.4 times it: to a thousandth of it the soonest next to a time that fails.
[[nodiscard]] BaselineResult soonest(const Baseline& baseline, const ProfileRequest& request,
                                     double duration_s);

}  // namespace joulepath
