#pragma once

#include <span>
#include <string_view>

#include "planner/values/profile.hpp"
#include "planner/values/profile_request.hpp"

namespace joulepath {

/// What is known of a robot on its piece of path at an instant, and what has changed since the plan.
struct Situation {
  double s{};                              ///< path coordinate
  double rate{};                           ///< of the path coordinate, >= 0
  double acceleration{};                   ///< of the path coordinate; of use under a jerk limit only
  double payload_kg{};                     ///< on board now, as stated; above the robot's limit it stops
  double time_left_s{kNoLimit};            ///< to the deadline of the piece's end
  std::span<const SpeedCap> speed_caps{};  ///< besides the request's
  double stop_at{kNoLimit};                ///< the path is blocked from here on: stand before it
};

/// How much work a call may do. What is found by then is returned.
struct ReplanBudget {
  int iterations{60};
  double cpu_s{kNoLimit};  ///< of the calling thread
};

enum class ReplanStatus {
  optimal,   ///< the least energy on the grid, to 1e-6
  feasible,  ///< within every limit and in time; the budget ended before the least energy was found
  late,      ///< no profile on the grid meets the deadline: the fastest one
  stopping,  ///< no profile leads to the end within the limits: brakes to a stop
};
[[nodiscard]] const char* replan_status_name(ReplanStatus status);

/// A new profile from the situation on. Refers to storage of the Replanner, until its next call.
struct Replan {
  ReplanStatus status{ReplanStatus::stopping};
  const Profile* profile{};  ///< s from the situation's place on, time from 0
  double duration_s{};
  double energy_J{};         ///< at the battery's terminals, standby included, as the grid counts it
  double gap_percent{};      ///< bound of (energy - least energy on the grid)/energy; no number if unknown
  double price_of_time_W{};  ///< -dE/dT
  double late_s{};           ///< after the deadline
  double above_cap_until{};  ///< the situation is faster than a cap here: braking ends at this coordinate
  double overrun{};          ///< of `stop_at` or the end of the path, where it cannot stop before
  std::string_view limit{};  ///< that prevents a profile, of `stopping`
  int iterations{};
};

}  // namespace joulepath
