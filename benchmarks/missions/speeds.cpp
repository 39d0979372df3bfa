#include "benchmarks/missions/speeds.hpp"

namespace joulepath::bench {
namespace {

const PlanOptions kOptions{.solver = SolverChoice::fast, .baselines = false};
constexpr int kMissions = 40;

}  // namespace

double ten_legs_s(const Floor& floor, std::mt19937& random) {
  MissionRequest mission{.name = "ten_legs"};
  const Station dock = random_place(floor, random, nullptr);
  mission.stations["dock"] = dock;
  mission.start = {.station = "dock", .pose = {dock.x_m, dock.y_m, 0.0}, .heading_given = false};
  for (int k = 1; k < 10; ++k) {
    const std::string name = "stop_" + std::to_string(k);
    mission.stations[name] = random_place(floor, random, &dock);
    mission.legs.push_back({.to = name, .payload = {2.0, 2.0}});
  }
  mission.legs.push_back({.to = "dock", .payload = {2.0, 2.0}});
  const double begin_s = cpu_s();
  const Plan plan = plan_mission(mission, floor.world, kOptions, &floor.space);
  return plan.infeasibility ? ten_legs_s(floor, random) : cpu_s() - begin_s;
}

double given_paths_s(const Robot& robot, std::mt19937& random) {
  std::uniform_real_distribution<double> handle_m(1.0, 3.0), across_m(-2.0, 2.0);
  double sum_s = 0.0;
  for (int k = 0; k < kMissions; ++k) {
    MissionRequest mission{.name = "given_paths"};
    for (int leg = 0; leg < 2; ++leg)
      mission.legs.push_back({.path = PathRequest{.bezier_m = {{{{0, 0},
                                                                 {handle_m(random), 0},
                                                                 {4, across_m(random)},
                                                                 {4 + handle_m(random), across_m(random)}}}}},
                              .payload = {2.0, 2.0}});
    const double begin_s = cpu_s();
    const Plan plan = plan_mission(mission, {.robot = robot}, kOptions);
    sum_s += cpu_s() - begin_s;
  }
  return sum_s / kMissions;
}

}  // namespace joulepath::bench
