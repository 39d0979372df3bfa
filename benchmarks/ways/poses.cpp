#include "benchmarks/ways/poses.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "scenarios/mission_files/map_file.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "tests/planner/path/grids.hpp"

namespace joulepath::ways {
namespace {

constexpr double kClearance_m = 0.05;
constexpr double kFromEdge_m = 1.0;

Answer answer_of(const World& world, const MissionRequest& mission) {
  const PlanOptions options{.solver = SolverChoice::fast, .nodes = 200, .baselines = false};
  const Plan plan = plan_mission(mission, world.world, options, &world.space);
  if (plan.status != SolveStatus::optimal && plan.status != SolveStatus::feasible) return {kNoLimit, false};
  const auto& stretches = plan.legs.front().stretches;
  return {plan.energy.total_J(), std::any_of(stretches.begin(), stretches.end(),
                                             [](const StretchPlan& s) { return is_turn(s.request.piece); })};
}

bool is_free(const World& world, const Point2& at_m) {
  const auto extent = world.space.field().extent_m();
  return at_m[0] > extent.x_min_m + kFromEdge_m && at_m[0] < extent.x_max_m - kFromEdge_m &&
         at_m[1] > extent.y_min_m + kFromEdge_m && at_m[1] < extent.y_max_m - kFromEdge_m &&
         world.space.field().disc_free(at_m[0], at_m[1], world.space.any_heading().radius_m() + 0.01);
}

}  // namespace

double Problem::reach_m() const { return std::hypot(goal_m[0] - start.x_m, goal_m[1] - start.y_m); }

World make_world(const std::string& name) {
  MissionWorld world{.robot = read_robot("scenarios/robots/nomad_super_scout.yaml")};
  world.map = name == "empty" ? free_grid(600, 600, 0.05) : read_map("scenarios/maps/" + name + ".yaml");
  RouteSpace space(*world.map, nullptr, world.robot.footprint, kClearance_m);
  return {name, std::move(world), std::move(space), {}};
}

Problem random_problem(const World& world, unsigned seed, unsigned index) {
  std::seed_seq seeds{seed, index};
  std::mt19937 random(seeds);
  const auto uniform = [&](double from, double to) {
    return from + (to - from) * (static_cast<double>(random()) / 4294967296.0);
  };
  const auto extent = world.space.field().extent_m();
  while (true) {
    Problem problem{.floor = world.name};
    problem.start.x_m = uniform(extent.x_min_m, extent.x_max_m);
    problem.start.y_m = uniform(extent.y_min_m, extent.y_max_m);
    problem.start.heading_rad = uniform(-std::numbers::pi, std::numbers::pi);
    const double reach_m = std::exp(uniform(0.0, std::log(10.0)));
    const double bearing_rad = uniform(-std::numbers::pi, std::numbers::pi);
    const double heading_rad = uniform(-std::numbers::pi, std::numbers::pi);
    problem.goal_m = {problem.start.x_m + reach_m * std::cos(bearing_rad),
                      problem.start.y_m + reach_m * std::sin(bearing_rad)};
    if (index % 2 == 1) problem.goal_heading_rad = heading_rad;
    const Point2 start_m{problem.start.x_m, problem.start.y_m};
    if (is_free(world, start_m) && is_free(world, problem.goal_m) &&
        world.space.any_heading().connected(start_m, problem.goal_m))
      return problem;
  }
}

MissionRequest mission_of(const Problem& problem) {
  MissionRequest mission{.name = "pose", .clearance_m = kClearance_m};
  mission.stations["goal"] = {
      .x_m = problem.goal_m[0], .y_m = problem.goal_m[1], .heading_rad = problem.goal_heading_rad};
  mission.start.pose = problem.start;
  mission.legs = {{.to = "goal", .payload = {problem.payload_kg, problem.payload_kg}}};
  return mission;
}

Answer planned(const World& world, const Problem& problem) { return answer_of(world, mission_of(problem)); }

double driven_J(const World& world, const Problem& problem, const Path& path) {
  MissionRequest mission = mission_of(problem);
  mission.legs.front().path = PathRequest{.ready = path};
  return answer_of(world, mission).energy_J;
}

double plain_J(const World& world, const Problem& problem) {
  const double dx = problem.goal_m[0] - problem.start.x_m, dy = problem.goal_m[1] - problem.start.y_m;
  const double bearing_rad = std::atan2(dy, dx);
  Path path;
  append_turn_to(path, problem.start, bearing_rad);
  path.pieces.push_back(
      straight_piece({problem.start.x_m, problem.start.y_m, bearing_rad}, problem.reach_m()));
  if (problem.goal_heading_rad) append_turn_to(path, path.end(), *problem.goal_heading_rad);
  if (world.space.checker().first_collision(path)) return kNoLimit;
  return driven_J(world, problem, path);
}

}  // namespace joulepath::ways
