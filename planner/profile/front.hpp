#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/values/profile_request.hpp"
#include "planner/values/profile_result.hpp"

namespace joulepath {

/// A stretch of a front. With the grid of its plan, the front agrees with the plan.
struct FrontStretch {
  ProfileRequest request;
  std::vector<double> grid{};  ///< path coordinates of nodes; empty: a grid of its own
};

/// One point of the energy-time front: the least energy (J, standby included) for its duration.
struct FrontPoint {
  double duration_s{};
  double energy_J{};
  double motion_energy_J{};
  double price_of_time_W{};  ///< exact slope -dE/dT: the price at which this point is optimal
  double gap_J{};  ///< no profiles take less energy by more in this time; not a number for the least time
  double gap_s{};  ///< no profiles take less time by more, for the least time
  std::vector<double> stretch_s{};  ///< duration of each stretch
  std::size_t drive{};              ///< index of its drive, of several
  std::string ways{};               ///< name of the plan whose paths it drives, of several

  /// (value - lower bound)/value, of energy or of the least time.
  [[nodiscard]] double gap_percent() const;
  /// Optimal if the gap is within the accuracy (a share).
  [[nodiscard]] SolveStatus status(double accuracy) const;
};

/// Stretches that are driven one after the other, and the time (s) and energy (J) that they take beside their
/// profiles, more than the first drive does.
struct FrontDrive {
  std::vector<FrontStretch> stretches{};
  FrontPoint more{};
};

struct Front {
  std::vector<FrontPoint> points{};  ///< from the shortest to the most economical duration
  SolveSummary summary{};            ///< infeasible or failed if there is no front
  std::optional<Infeasibility> infeasibility{};
};

/// The front of stretches that are driven one after the other (a leg, a mission), from the minimum time to
/// the time of least energy, or of the lowest price where slower is always cheaper. All stretches have the
/// same price of a second, which is optimal for their sum. Each stretch is transcribed once, with limits
/// tightened as for its plan; new prices are chosen in the widest gaps of the front. Each point has its own
/// bound (certification.hpp). The fastest point has an infinite price. Where the least time is the cheapest,
/// the front is that point alone, and the summary's message says so.
[[nodiscard]] Front energy_time_front(const std::vector<FrontStretch>& stretches, std::size_t points,
                                      double lowest_price_W = 0.0);

/// The lower envelope of the fronts of several drives that lead to the same place, not always convex: points
/// that another drive undercuts are left out. With a lowest price it ends no later than the first drive's
/// front. A drive other than the first that cannot be driven is left out.
[[nodiscard]] Front lowest_front(const std::vector<FrontDrive>& drives, std::size_t points,
                                 double lowest_price_W = 0.0);

}  // namespace joulepath
