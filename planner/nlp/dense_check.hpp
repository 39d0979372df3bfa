#pragma once

#include <vector>

#include "planner/nlp/problem.hpp"

namespace joulepath::nlp {

/// What a look between the nodes finds.
struct DenseCheck {
  double worst_ratio{};               ///< of any limit; above 1 is a violation
  std::vector<Tightening> tighten{};  ///< limits to take back, by segment
  std::vector<bool> cut{};            ///< segments that need a node inside
  double energy_J{};                  ///< exact, standby left out
  double energy_error_J{};            ///< |sum of (transcribed - exact)|
};

/// Looks at every limit on sub-points of every segment, and at the energy of every segment.
[[nodiscard]] DenseCheck check_densely(const Problem& problem, const PathMotion& motion,
                                       const Profile& profile, double accuracy);

}  // namespace joulepath::nlp
