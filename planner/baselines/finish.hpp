#pragma once

#include <functional>
#include <vector>

#include "planner/baselines/baseline.hpp"

namespace joulepath {

/// Completes a baseline's profile: waits at the end until `duration_s`, checks every limit densely, computes
/// the energy on the exact path. Infeasible (with the reason) if it is too slow or exceeds a limit.
[[nodiscard]] BaselineResult finish_baseline(const ProfileRequest& request, std::string name, Profile profile,
                                             double duration_s, std::map<std::string, double> parameters);

/// The result if a baseline does not exist for this request.
[[nodiscard]] BaselineResult no_baseline(std::string name, std::string reason);

/// The order of results: valid before invalid, then less energy, then less excess.
[[nodiscard]] bool better(const BaselineResult& result, const BaselineResult& than);

/// The result of `make` for the request. If corners between its nodes exceed a limit slightly, `make` is
/// called again with that limit lowered; the check uses the request's own limits.
[[nodiscard]] BaselineResult with_room(const ProfileRequest& request,
                                       const std::function<BaselineResult(const ProfileRequest&)>& make);

/// The best result of `make` over shares of the yaw acceleration, each through with_room(): a share whose
/// corners exceed a limit slightly must not lose against a smaller one. `shares` is not empty.
[[nodiscard]] BaselineResult best_share(
    const ProfileRequest& request, const std::vector<double>& shares,
    const std::function<BaselineResult(const ProfileRequest& inner, double share)>& make);

}  // namespace joulepath
