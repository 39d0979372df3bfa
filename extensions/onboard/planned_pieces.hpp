#pragma once

#include <string>
#include <vector>

#include "model/trajectory.hpp"
#include "planner/values/profile.hpp"
#include "planner/values/profile_request.hpp"

namespace joulepath {

/// A piece of a written plan that is driven without a stop, as its trajectory.csv shows it.
struct PlannedDrive {
  ProfileRequest request;
  Profile plan{};
  double start_s{};  ///< in the plan's time
  double end_s{};
  std::size_t leg{};
};

/// What a plan's directory says is driven, in order, and how the plan counts it.
struct PlannedDrives {
  std::vector<PlannedDrive> drives{};
  Pose start{};
  double duration_s{};
  double energy_J{};
};

/// The pieces of a planned trajectory: curves as lines of linear curvature through its samples, turns in
/// place, and rest between them. Limits and effects are the robot's.
[[nodiscard]] PlannedDrives planned_drives(const Trajectory& planned, const Robot& robot);
/// Those of trajectory.csv in a plan's directory. Throws ConfigError, also for a plan of another robot.
[[nodiscard]] PlannedDrives read_planned_drives(const std::string& directory, const Robot& robot);

}  // namespace joulepath
