#pragma once

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
  std::string solver{};       ///< ipopt | fast | forward_backward
  int iterations{};           ///< over all refinements
  std::size_t nodes{};        ///< of the last grid
  double price_of_time_W{};   ///< -dE/dT: multiplier of the time row (standby included), 0 where time is free
  double lower_bound_J{};     ///< of the energy (of E + price T with time_price, of T with minimum_time)
  double gap_percent{};       ///< (value - lower bound)/value, discretization estimate included
  bool local{};               ///< the problem is not convex here: the bound is the best known, not a proof
  std::string handed_over{};  ///< why the fast solver gave over to Ipopt; empty if it did not
  std::string message{};
};

struct ProfileResult {
  SolveSummary summary{};
  std::optional<Profile> profile{};
  std::optional<Infeasibility> infeasibility{};
};

}  // namespace joulepath
