#pragma once

#include "planner/motion/path_motion.hpp"
#include "planner/nlp/transcription/forward_backward.hpp"
#include "planner/nlp/transcription/solution.hpp"
#include "planner/values/profile.hpp"
#include "planner/values/profile_result.hpp"

namespace joulepath {

/// Fills a summary's bound, gap and `local` for a profile of least energy: the dual bound on its grid, and
/// what half of the nodes cost more as an estimate of the discretization.
void certify_energy(const nlp::Problem& problem, const PathMotion& motion, const nlp::RateEnvelope& envelope,
                    const nlp::Solution& solution, const Profile& profile, SolveSummary& summary);

/// The same for a profile of least time: by the dual bound of the same problem with time as its objective.
void certify_time(const nlp::Problem& problem, const nlp::RateEnvelope& envelope, const Profile& profile,
                  SolveSummary& summary);

}  // namespace joulepath
