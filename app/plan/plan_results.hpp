#pragma once

#include <string>

#include "app/report/report.hpp"
#include "planner/values/mission_request.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// A plan with its inputs, and its output files.
struct PlanResults {
  MissionRequest mission{};
  MissionWorld world{};
  Plan plan{};
  bool valid{};             ///< there is a trajectory
  Trajectory trajectory{};  ///< of a valid plan
  std::string json{};       ///< plan.json

  [[nodiscard]] std::string trajectory_text() const;                                ///< trajectory.csv
  [[nodiscard]] std::string profile_text() const;                                   ///< profile.csv
  [[nodiscard]] std::string report(const report::Operation& operation = {}) const;  ///< report.html
};

/// The results of a plan of a mission.
[[nodiscard]] PlanResults plan_results(MissionRequest mission, MissionWorld world, Plan plan);

}  // namespace joulepath
