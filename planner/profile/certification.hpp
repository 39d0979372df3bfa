#pragma once

#include "planner/motion/path_motion.hpp"
#include "planner/nlp/transcription/solution.hpp"
#include "planner/profile/least_time.hpp"
#include "planner/profile/lower_bound.hpp"
#include "planner/values/profile.hpp"
#include "planner/values/profile_result.hpp"

namespace joulepath {

/// Fills a summary's bound, gap and `local` for a profile of least energy. Returns the gap by segment.
/// `driving_J`: energy at the terminals without standby.
DualGap certify_energy(const nlp::Problem& problem, const PathMotion& motion, const nlp::Solution& solution,
                       const Profile& profile, double driving_J, SolveSummary& summary);

/// The same for a profile of least time.
LeastTime certify_time(const nlp::Problem& problem, const PathMotion& motion, const Profile& profile,
                       SolveSummary& summary);

}  // namespace joulepath
