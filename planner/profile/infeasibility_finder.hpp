#pragma once

#include "planner/nlp/transcription/forward_backward.hpp"
#include "planner/values/infeasibility.hpp"

namespace joulepath {

/// The verdict for a request whose rate envelope is blocked: which limit, where, by how much, and the
/// smallest value of it for which a profile exists (found by bisection on the envelope, then planned).
[[nodiscard]] Infeasibility explain_blocked(const ProfileRequest& request, const nlp::Problem& problem,
                                            const nlp::Blocked& blocked);

/// Keeps what a verdict of the same request with fewer limits offers only as far as the planner finds a
/// profile with it.
void offer_what_plans(const ProfileRequest& request, Infeasibility& verdict);

/// The verdict for a time that is longer than the slowest profile takes.
[[nodiscard]] Infeasibility explain_long(const ProfileRequest& request, double possible_s);

/// The verdict for a time below `least_s`, the proven minimum: the time of the fastest drive, and the limit
/// that holds it.
[[nodiscard]] Infeasibility explain_late(const ProfileRequest& request, double least_s);

/// The verdict for an invalid path or number of the request.
[[nodiscard]] Infeasibility explain_request(const ProfileRequest& request, std::string constraint,
                                            std::string message);

}  // namespace joulepath
