#pragma once

#include <map>
#include <optional>
#include <string>

#include "planner/values/profile.hpp"

namespace joulepath {

/// A classic profile on the same piece, at the same distance and total time as a plan.
struct BaselineResult {
  std::string name{};  ///< trapezoid_max_acceleration | trapezoid_best_tuned | ...
  bool feasible{};     ///< false: exceeds a limit or is too slow; not counted
  std::string reason{};
  double energy_J{};         ///< at the battery's terminals, standby included
  double motion_energy_J{};  ///< without standby
  double duration_s{};
  std::map<std::string, double> parameters{};  ///< settings with their units
  double worst_use{};                          ///< of any limit; above 1 is a violation
  std::string worst_limit{};                   ///< which
  std::optional<Profile> profile{};
};

}  // namespace joulepath
