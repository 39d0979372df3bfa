#pragma once

#include <vector>

#include "planner/joint/joint_starts.hpp"

// Design: docs/decisions/0212-joint-path-and-speed.md
namespace joulepath::joint {

/// Legs to be planned together: the robot stands at each stop and leaves it in the heading of its arrival,
/// forward or in reverse.
struct JointQuery {
  Pose start{};
  std::vector<LegGoal> goals{};
  std::vector<DriveLaw> laws{};          ///< forward, per leg
  std::vector<DriveLaw> reverse_laws{};  ///< the same; empty: no start drives in reverse
  const FootprintChecker* checker{};     ///< null: an open floor
};

/// Paths of the legs and what they cost by the joint program.
struct JointPaths {
  std::vector<Path> legs{};
  double cost_J{};
  std::vector<Sketch> sketches{};  ///< the same legs as starts
};

/// The cheapest paths found from the starts, in the order of their cost: all starts on a coarse grid, a start
/// given up as soon as it cannot be the best, the best of them on a finer one. Each reaches its goals to
/// rounding and is free of collisions along its whole length. Deterministic.
[[nodiscard]] std::vector<JointPaths> best_joint_paths(const JointQuery& query,
                                                       const std::vector<std::vector<Sketch>>& starts);

/// The cheapest of the starts on the coarse grid alone: a start for a longer program, its paths meet their
/// goals to a centimetre.
[[nodiscard]] std::optional<JointPaths> best_coarse_paths(const JointQuery& query,
                                                          const std::vector<std::vector<Sketch>>& starts);

/// The paths of parameters, one per leg, turned and moved to the program's frame.
[[nodiscard]] std::vector<Path> paths_of(const Program& program, const Eigen::VectorXd& parameters);

}  // namespace joulepath::joint
