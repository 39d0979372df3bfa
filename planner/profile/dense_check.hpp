#pragma once

#include <vector>

#include "planner/motion/path_motion.hpp"
#include "planner/nlp/transcription/problem.hpp"
#include "planner/values/profile.hpp"

namespace joulepath::nlp {

/// What a look between the nodes finds.
struct DenseCheck {
  double worst_ratio{};               ///< of any limit; above 1 is a violation
  std::vector<Tightening> tighten{};  ///< limits to tighten, by segment
  std::vector<bool> cut{};            ///< segments that need a node inside
  double energy_J{};                  ///< exact, standby left out
  double energy_error_J{};            ///< |sum of (transcribed - exact)|
};

/// What each segment costs as the problem counts it, standby left out.
[[nodiscard]] std::vector<double> counted_energy_J(const Problem& problem, const std::vector<double>& b);

/// Looks at every limit on sub-points of every segment, and at the energy of every segment against what was
/// counted for it.
[[nodiscard]] DenseCheck check_densely(const Problem& problem, const PathMotion& motion,
                                       const Profile& profile, const std::vector<double>& counted_energy_J,
                                       double accuracy);

}  // namespace joulepath::nlp
