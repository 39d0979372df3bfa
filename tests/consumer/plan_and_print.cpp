#include <iostream>
#include <joulepath/planner/mission/mission.hpp>
#include <joulepath/scenarios/mission_files/mission_file.hpp>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    const joulepath::MissionRequest mission = joulepath::read_mission(argv[1]);
    const joulepath::MissionWorld world = joulepath::read_world(mission);
    const joulepath::Plan plan = joulepath::plan_mission(mission, world, {});
    std::cout << joulepath::solve_status_name(plan.status) << ": " << plan.energy.total_J() << " J, "
              << plan.duration_s << " s\n";
    for (const joulepath::LegPlan& leg : plan.legs)
      std::cout << "  to " << leg.to << ": " << leg.energy.total_J() << " J\n";
    return plan.infeasibility ? 1 : 0;
  } catch (const joulepath::ConfigError& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
