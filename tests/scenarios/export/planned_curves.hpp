#pragma once

#include "planner/mission/mission.hpp"
#include "scenarios/export/exports.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "tests/support/locations.hpp"

namespace joulepath::testing {

/// A planned mission with all inputs of an export.
struct Planned {
  MissionRequest mission{};
  MissionWorld world{};
  Plan plan{};
  Plant plant{};

  explicit Planned(MissionRequest request) : mission(std::move(request)) {
    mission.robot_file = JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml";
    world = read_world(mission);
    plan = plan_mission(mission, world, {.solver = SolverChoice::fast, .nodes = 60, .accuracy = 1e-3});
    plant = make_plant(world.robot);
  }
  ExportInput input(const std::string& file) const { return {mission, world, plan, plant, file, {}}; }
};

/// The paper's curve, a turn and a straight; a dwell between them, and more time than the robot needs.
inline const Planned& curves() {
  static const Planned planned = [] {
    LegRequest curve{.path = PathRequest{.bezier_m = {{{{0, 0}, {2.7, 0}, {2.7, 0}, {2.7, 2.7}}}}},
                     .payload = {5.7, 5.7},
                     .dwell_s = 5};
    LegRequest back{.path = PathRequest{.bezier_m = {{{{0, 0}, {-1, 0}, {-3, 0}, {-4, 0}}}}},
                    .payload = {1, 1}};
    return Planned({.name = "curves", .legs = {curve, back}, .objective = {.deadline_s = 40}});
  }();
  return planned;
}

}  // namespace joulepath::testing
