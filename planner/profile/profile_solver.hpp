#pragma once

#include <optional>

#include "planner/values/profile_request.hpp"
#include "planner/values/profile_result.hpp"

namespace joulepath {

/// Least-energy (or least-time) profile within every limit, also between nodes. Returns a verdict for an
/// impossible request and does not throw.
[[nodiscard]] ProfileResult solve_profile(const ProfileRequest& request);

/// The least time (s) that the fast solver finds for a request, whatever time it asks for; nothing where it
/// finds no profile.
[[nodiscard]] std::optional<double> least_time_found_s(ProfileRequest request);

/// Duration (s) of solve_profile()'s profile; nothing where it finds none. A search for a price of time asks
/// for no more: with a jerk limit most of the work is the bound of the problem without it, left out here.
[[nodiscard]] std::optional<double> driving_time_s(const ProfileRequest& request);

}  // namespace joulepath
