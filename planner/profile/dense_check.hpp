#pragma once

#include <vector>

#include "planner/motion/path_motion.hpp"
#include "planner/nlp/transcription/problem.hpp"
#include "planner/values/profile.hpp"

namespace joulepath::nlp {

/// Result of the check between the nodes.
struct DenseCheck {
  double worst_ratio{};               ///< of any limit; above 1 is a violation
  std::vector<Tightening> tighten{};  ///< limits to tighten, by segment
  std::vector<bool> cut{};            ///< segments that need a node inside
  double energy_J{};                  ///< exact, without standby
  double energy_error_J{};            ///< |sum of (transcribed - exact)|
};

/// Cost of each segment as the problem counts it, without standby.
[[nodiscard]] std::vector<double> counted_energy_J(const Problem& problem, const std::vector<double>& b);

/// Checks every limit at places within every segment, and the energy of every segment against the counted
/// one.
[[nodiscard]] DenseCheck check_densely(const Problem& problem, const PathMotion& motion,
                                       const Profile& profile, const std::vector<double>& counted_energy_J,
                                       double accuracy);

}  // namespace joulepath::nlp
