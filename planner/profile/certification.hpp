#pragma once

#include "planner/motion/path_motion.hpp"
#include "planner/nlp/transcription/forward_backward.hpp"
#include "planner/nlp/transcription/solution.hpp"
#include "planner/profile/lower_bound.hpp"
#include "planner/values/profile.hpp"
#include "planner/values/profile_result.hpp"

namespace joulepath {

/// Fills a summary's bound, gap and `local` for a profile of least energy. Returns the gap by segment.
DualGap certify_energy(const nlp::Problem& problem, const PathMotion& motion, const nlp::Solution& solution,
                       const Profile& profile, SolveSummary& summary);

/// The same for a profile of least time: by the multipliers of the same problem with time as its objective.
DualGap certify_time(const nlp::Problem& problem, const PathMotion& motion, const nlp::RateEnvelope& envelope,
                     const Profile& profile, SolveSummary& summary);

}  // namespace joulepath
