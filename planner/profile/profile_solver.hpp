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

}  // namespace joulepath
