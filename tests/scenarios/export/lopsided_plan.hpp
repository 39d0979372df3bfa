#pragma once

#include "planner/accounts/plan_trajectory.hpp"
#include "planner/mission/mission.hpp"
#include "scenarios/export/exports.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath::testing {

/// Its sides differ in every constant.
inline Robot lopsided() {
  Robot robot = nomad();
  robot.geometry.wheel_radius_m = {0.1, 0.102};
  robot.motor.right.resistance_ohm = 3.1;
  robot.motor.right.voltage_constant_V_s_rad = 0.066;
  robot.power.regeneration_efficiency = 0.5;
  return robot;
}

/// A curve to the left, a dwell, a turn on the spot, and a curve to the right with a load; it ends at (4, 0).
struct PlannedCurves {
  MissionRequest mission{};
  MissionWorld world{.robot = lopsided()};
  Plan plan{};
  Plant plant{};

  PlannedCurves() {
    const LegRequest left{.path = PathRequest{.bezier_m = {{{{0, 0}, {1.5, 0}, {2, 0.5}, {2, 2}}}}},
                          .dwell_s = 1};
    const LegRequest right{.path = PathRequest{.bezier_m = {{{{0, 0}, {0, -1.5}, {-0.5, -2}, {-2, -2}}}}},
                           .payload = {6, 6}};
    mission = {.name = "curves", .legs = {left, right}, .objective = {.deadline_s = 25}};
    plan = plan_mission(mission, world,
                        {.solver = SolverChoice::fast, .nodes = 60, .accuracy = 1e-3, .baselines = false});
    plant = make_plant(world.robot);
  }
  ExportInput input(const std::string& file) const { return {mission, world, plan, plant, file, 50.0}; }
};

inline const PlannedCurves& lopsided_plan() {
  static const PlannedCurves planned;
  return planned;
}

/// The plan at the samples of an export.
inline const Trajectory& lopsided_rows() {
  static const Trajectory rows = plan_trajectory(lopsided_plan().plan, lopsided_plan().plant, 50.0);
  return rows;
}

}  // namespace joulepath::testing
