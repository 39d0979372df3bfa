#pragma once

#include "planner/values/profile_request.hpp"
#include "planner/values/profile_result.hpp"

namespace joulepath {

/// A locally optimal profile under a finite jerk limit (nlp/jerk_program.hpp) that keeps every limit
/// between nodes; `feasible`, or `failed` with the solver's message. Neither bound nor verdict.
[[nodiscard]] ProfileResult find_profile_with_jerk_limit(const ProfileRequest& request);

}  // namespace joulepath
