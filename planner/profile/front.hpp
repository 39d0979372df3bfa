#pragma once

#include <optional>
#include <vector>

#include "planner/values/profile_request.hpp"
#include "planner/values/profile_result.hpp"

namespace joulepath {

/// A stretch of a front. With the grid and the status of its plan, the front agrees with the plan.
struct FrontStretch {
  ProfileRequest request;
  std::vector<double> grid{};                  ///< path coordinates of nodes; empty: a grid of its own
  SolveStatus status{SolveStatus::feasible};  ///< proven for the plan; a front has no bounds of its own
};

/// One point of the energy-time front: the least energy (J, standby included) for its duration.
struct FrontPoint {
  double duration_s{};
  double energy_J{};
  double motion_energy_J{};
  double price_of_time_W{};  ///< exact slope -dE/dT: the price at which this point is optimal
  SolveStatus status{SolveStatus::failed};  ///< the worst of its stretches
  std::vector<double> stretch_s{};  ///< duration of each stretch
};

struct Front {
  std::vector<FrontPoint> points{};  ///< from the shortest to the most economical duration
  SolveSummary summary{};            ///< infeasible or failed if there is no front
  std::optional<Infeasibility> infeasibility{};
};

/// The front of stretches that are driven one after the other (a leg, a mission), from the minimum time to
/// the time of least energy. All stretches have the same price of a second, which is optimal for their sum.
/// Each stretch is transcribed once, with limits tightened as for its plan; new prices are chosen in the
/// widest gaps of the front. The fastest point has an infinite price.
[[nodiscard]] Front energy_time_front(const std::vector<FrontStretch>& stretches, std::size_t points);

}  // namespace joulepath
