#pragma once

#include <optional>
#include <vector>

#include "planner/motion/path_motion.hpp"
#include "planner/nlp/fast/fast_solver.hpp"
#include "planner/path/geometry/path_slopes.hpp"

// Design: docs/decisions/0211-whole-curves.md
namespace joulepath {

/// Drafts (ProfileRequest::draft) of curves that an optimizer changes little by little, without the general
/// solver's cases: no deadline, one price of time. Nodes keep their shares of the lengths between mandatory
/// nodes, so that the cost is smooth; each solve begins at the last solution.
class DraftSeries {
 public:
  explicit DraftSeries(double tolerance = 1e-7) : tolerance_(tolerance) {}

  struct Cost {
    double cost_J{};  ///< energy from the battery, standby and the price of time
    double duration_s{};
  };
  /// The least cost; absent where the curve cannot be driven.
  [[nodiscard]] std::optional<Cost> solve(const ProfileRequest& request);
  /// Derivatives of the last cost by its curve; requires that there was one.
  [[nodiscard]] PathSlopes slopes() const;

 private:
  struct Place {
    std::size_t part{};  ///< between two mandatory nodes
    double share{};
  };
  std::vector<double> grid(const PathMotion& motion, const ProfileRequest& request);
  [[nodiscard]] bool solve_warm();
  [[nodiscard]] bool solve_cold();

  double tolerance_;  ///< of the solver, relative to the cost
  std::optional<ProfileRequest> request_{};
  std::optional<PathMotion> motion_{};
  nlp::Problem problem_{};
  nlp::Solution solution_{};
  nlp::FastSolver solver_{};
  std::vector<double> mandatory_{};
  std::vector<Place> places_{};
  std::size_t parts_{};
};

}  // namespace joulepath
