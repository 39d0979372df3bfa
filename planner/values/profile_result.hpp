#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include "planner/values/infeasibility.hpp"
#include "planner/values/profile.hpp"

namespace joulepath {

enum class SolveStatus { optimal, feasible, infeasible, failed };
[[nodiscard]] const char* solve_status_name(SolveStatus status);

struct SolveSummary {
  SolveStatus status{SolveStatus::failed};
  std::string solver{};      ///< ipopt | fast | forward_backward | s_curve
  int iterations{};          ///< over all refinements
  std::size_t nodes{};       ///< of the last grid
  double price_of_time_W{};  ///< -dE/dT: multiplier of the duration row (standby included), 0 if the time is
                             ///< free
  /// Lower bound of the energy (J, standby included) within the limits, in the requested time; with a price
  /// of time, in this profile's time. Not a number for a profile of least time.
  double lower_bound_J{std::nan("")};
  double lower_bound_s{std::nan("")};  ///< lower bound of the time, for a profile of least time
  double gap_percent{};                ///< (value - lower bound)/value, of energy or time
  bool local{};               ///< the bound is not closed because the problem is not convex: a local optimum
  double counted_J{};         ///< energy as the problem counts it, of a draft
  std::string handed_over{};  ///< why the fast solver handed over to Ipopt; empty if it did not
  std::string message{};
};

struct ProfileResult {
  SolveSummary summary{};
  std::optional<Profile> profile{};
  std::optional<Infeasibility> infeasibility{};
};

}  // namespace joulepath
