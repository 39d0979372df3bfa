#pragma once

#include <functional>
#include <vector>

#include "planner/baselines/baseline.hpp"

namespace joulepath {

/// Judges a baseline's profile: waits at the end until `duration_s`, checks every limit densely, takes the
/// energy on the exact path. Infeasible (with the reason) when it is too slow or breaks a limit.
[[nodiscard]] BaselineResult finish_baseline(const ProfileRequest& request, std::string name, Profile profile,
                                             double duration_s, std::map<std::string, double> parameters);

/// A baseline that does not exist for this request.
[[nodiscard]] BaselineResult no_baseline(std::string name, std::string reason);

/// Valid before invalid, then cheaper, then less in excess.
[[nodiscard]] bool better(const BaselineResult& result, const BaselineResult& than);

/// What `make` gives for the request; where corners between its nodes bring a limit slightly above, again
/// with that limit lowered (in what make() is called with; it judges by the request itself).
[[nodiscard]] BaselineResult with_room(const ProfileRequest& request,
                                       const std::function<BaselineResult(const ProfileRequest&)>& make);

/// The best over shares of the yaw acceleration of what `make` gives for each with room of its own: a share
/// that needs room must not lose against a more timid one that does not. `shares` holds one at least.
[[nodiscard]] BaselineResult best_share(
    const ProfileRequest& request, const std::vector<double>& shares,
    const std::function<BaselineResult(const ProfileRequest& inner, double share)>& make);

}  // namespace joulepath
