#pragma once

#include <functional>
#include <vector>

#include "planner/values/baseline_result.hpp"
#include "planner/values/profile_request.hpp"

namespace joulepath {

/// The two trapezoids with which every plan is compared, in `duration_s` (waiting included).
[[nodiscard]] BaselineResult trapezoid_max_acceleration(const ProfileRequest& request, double duration_s);
[[nodiscard]] BaselineResult trapezoid_best_tuned(const ProfileRequest& request, double duration_s);

/// A family of classic profiles: returns its member that takes a time.
using Baseline = std::function<BaselineResult(const ProfileRequest& request, double duration_s)>;

/// All families, in the order of reports.
[[nodiscard]] const std::vector<Baseline>& baselines();
[[nodiscard]] std::vector<BaselineResult> all_baselines(const ProfileRequest& request, double duration_s);

/// A baseline at a time. If the family has no member for that time (a very tight time on a curved piece), the
/// soonest later one that the search finds: up to 1.4 times the time, to a thousandth of the time.
[[nodiscard]] BaselineResult soonest(const Baseline& baseline, const ProfileRequest& request,
                                     double duration_s);

}  // namespace joulepath
