// Throughput of planning: CPU time, with the built-in solver unless stated otherwise.
// usage: bench_throughput MISSIONS HEADER
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <set>

#include "app/jobs/mission_planner.hpp"
#include "benchmarks/support/cpu_time.hpp"
#include "benchmarks/support/prepared_problem.hpp"
#include "planner/nlp/fast/fast_solver.hpp"
#include "planner/profile/profile_solver.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "tests/planner/path/grids.hpp"
#include "tests/support/locations.hpp"

namespace {

using namespace joulepath;

constexpr double kClearance_m = 0.05;
const PlanOptions kFast{.solver = SolverChoice::fast, .baselines = false};
const std::string kScenarios = JOULEPATH_SOURCE_DIR "/scenarios/";

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

void row(const char* what, const char* measured, const char* aim, bool met) {
  std::printf("| %s | %s | %s | %s |\n", what, measured, aim, met ? "yes" : "**no**");
}

/// A row whose figure should be at most its target.
void at_most(const char* what, const char* format, double value, double aim) {
  char measured[64], target[64];
  std::snprintf(measured, sizeof measured, format, value);
  std::snprintf(target, sizeof target, format, aim);
  row(what, measured, (std::string("<= ") + target).c_str(), value <= aim);
}
void at_least(const char* what, const char* format, double value, double aim) {
  char measured[64], target[64];
  std::snprintf(measured, sizeof measured, format, value);
  std::snprintf(target, sizeof target, format, aim);
  row(what, measured, (std::string(">= ") + target).c_str(), value >= aim);
}

/// A place where the robot can turn, connected to another if one is given.
Station free_place(const RouteSpace& space, std::mt19937& random, const Station* from) {
  const auto extent = space.field().extent_m();
  std::uniform_real_distribution<> x_m(extent.x_min_m, extent.x_max_m), y_m(extent.y_min_m, extent.y_max_m);
  std::uniform_int_distribution<> quarter(0, 3);
  while (true) {
    const Station place{.x_m = std::round(100 * x_m(random)) / 100,
                        .y_m = std::round(100 * y_m(random)) / 100,
                        .heading_rad = 0.5 * std::numbers::pi * quarter(random)};
    const FreeSpace& floor = space.any_heading();
    if (!space.field().disc_free(place.x_m, place.y_m, floor.radius_m() + 0.3)) continue;
    if (!from || floor.connected({from->x_m, from->y_m}, {place.x_m, place.y_m})) return place;
  }
}

std::vector<Station> free_places(const RouteSpace& space, std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Station> places{free_place(space, random, nullptr)};
  while (places.size() < count) places.push_back(free_place(space, random, &places.front()));
  return places;
}

/// Ten legs between places of the 60 x 40 m floor.
void ten_legs(const Robot& robot) {
  MissionWorld world{.robot = robot, .map = warehouse_grid(1)};
  double begin_ms = cpu_ms();
  const RouteSpace first(*world.map, nullptr, robot.footprint, kClearance_m);
  const double floor_s = 1e-3 * (cpu_ms() - begin_ms);
  std::vector<double> anew_s, again_s;
  for (unsigned trial = 0; trial < 5; ++trial) {
    const RouteSpace space(*world.map, nullptr, robot.footprint, kClearance_m);
    const std::vector<Station> places = free_places(space, 11, trial);
    MissionRequest mission{.name = "ten_legs", .clearance_m = kClearance_m};
    mission.start.pose = {places[0].x_m, places[0].y_m, *places[0].heading_rad};
    for (std::size_t k = 1; k < places.size(); ++k) {
      mission.stations["s" + std::to_string(k)] = places[k];
      mission.stations["s" + std::to_string(k)].heading_rad.reset();
      mission.legs.push_back({.to = "s" + std::to_string(k), .payload = {2.0, 2.0}});
    }
    AnswerCache kept;
    PlanOptions options = kFast;
    options.answers.cache = &kept;
    for (std::vector<double>* sample : {&anew_s, &again_s}) {
      begin_ms = cpu_ms();
      const Plan plan = plan_mission(mission, world, options, &space);
      sample->push_back(1e-3 * (cpu_ms() - begin_ms));
    }
  }
  at_most("ten legs on the 60 x 40 m floor, floor prepared, routes and ways searched anew", "%.2f s",
          median(anew_s), 0.5);
  at_most("the same with the floor's preparation", "%.2f s", median(anew_s) + floor_s, 1.5);
  at_most("the same mission again, answers kept in memory", "%.3f s", median(again_s), 0.5);
}

void demo() {
  const MissionRequest mission = read_mission(kScenarios + "missions/warehouse_pick.yaml");
  const MissionWorld world = read_world(mission);
  const auto plan = [&](const char* what, SolverChoice solver, bool path_bound, double aim_s) {
    AnswerCache kept;
    PlanOptions options{.solver = solver, .path_bound = path_bound};
    options.answers.cache = &kept;
    const double begin_ms = cpu_ms();
    (void)plan_mission(mission, world, options);
    at_most(what, "%.2f s", 1e-3 * (cpu_ms() - begin_ms), aim_s);
  };
  plan("the demo's plan, with its trapezoids, without the bound over all paths", SolverChoice::fast, false,
       1);
  plan("the same, settled by Ipopt", SolverChoice::ipopt, false, 1);
  plan("the demo's plan, with its trapezoids and the bound", SolverChoice::fast, true, 1);
}

/// Missions of three legs between places of Nav2's warehouse, as lines of JSON. Every leg is between two of
/// `stations` places.
std::vector<MissionItem> warehouse_missions(std::size_t count, std::size_t stations, bool headings,
                                            unsigned seed) {
  const std::optional<OccupancyGrid> keepout = nav2_warehouse_keepout();
  const Robot robot = read_robot(kScenarios + "robots/nomad_super_scout.yaml");
  const RouteSpace space(*nav2_warehouse(), &*keepout, robot.footprint, kClearance_m);
  const std::vector<Station> places = free_places(space, stations, seed);
  std::mt19937 random(seed + 1);
  std::uniform_int_distribution<std::size_t> pick(0, stations - 1);
  std::vector<MissionItem> items;
  while (items.size() < count) {
    nlohmann::json mission{{"robot", kScenarios + "robots/nomad_super_scout.yaml"},
                           {"map", kScenarios + "maps/warehouse.yaml"},
                           {"keepout", kScenarios + "maps/warehouse_keepout.yaml"},
                           {"clearance_m", kClearance_m},
                           {"objective", {{"minimize", "energy"}}}};
    std::size_t before = stations;
    for (int stop = 0; stop < 4; ++stop) {
      std::size_t here = pick(random);
      while (here == before) here = pick(random);
      before = here;
      const std::string name = "s" + std::to_string(here);
      mission["stations"][name] = {{"x_m", places[here].x_m}, {"y_m", places[here].y_m}};
      if (headings) mission["stations"][name]["heading_rad"] = *places[here].heading_rad;
      if (stop == 0)
        mission["start"] = {{"station", name}};
      else
        mission["legs"].push_back({{"to", name}, {"payload_kg", 5.0}, {"dwell_s", 5}});
    }
    items.push_back(
        {.name = "m" + std::to_string(items.size()), .file = "benchmark", .text = mission.dump()});
  }
  return items;
}

struct Rate {
  double per_cpu_minute{};
  double wall_s{};
  std::size_t planned{};
};

Rate rate_of(MissionPlanner& planner, const std::vector<MissionItem>& items, std::size_t first,
             std::size_t count, unsigned threads) {
  std::vector<std::size_t> indices;
  for (std::size_t k = first; k < first + count; ++k) indices.push_back(k);
  Rate rate;
  const double begin_ms = cpu_ms();
  const auto begin = std::chrono::steady_clock::now();
  run_jobs(
      indices, threads,
      [&](std::size_t k) {
        return planner.plan(items[k], k, {{"name", items[k].name}});
      },
      [&](const JobResult& result) { rate.planned += result.line.find("energy_J") != std::string::npos; },
      [] { return false; });
  rate.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  rate.per_cpu_minute = 6e4 * static_cast<double>(count) / (cpu_ms() - begin_ms);
  return rate;
}

/// So few stations that every leg between two of them is driven about 19 times.
std::size_t stations_for(std::size_t missions) {
  const double pairs = 3.0 * static_cast<double>(missions) / 19;
  return std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(0.5 + std::sqrt(pairs))), 3, 40);
}

void batches(std::size_t count) {
  const std::size_t few = std::min<std::size_t>(count, 24);
  for (const bool headings : {true, false}) {
    const std::vector<MissionItem> items = warehouse_missions(few, 40, headings, 3);
    MissionPlanner planner(kFast, {});
    const Rate rate = rate_of(planner, items, 0, few, 1);
    at_least(headings ? "missions of 3 legs, 40 stations with headings, nothing kept before, per CPU-minute"
                      : "the same, stations without headings",
             "%.0f", rate.per_cpu_minute, 600);
  }
  const std::size_t stations = stations_for(count);
  const std::vector<MissionItem> items = warehouse_missions(2 * count, stations, true, 3);
  MissionPlanner planner(kFast, {});
  const Rate cold = rate_of(planner, items, 0, count, 1), warm = rate_of(planner, items, count, count, 1);
  char text[160];
  std::snprintf(text, sizeof text, "%zu missions of 3 legs, %zu stations with headings, per CPU-minute",
                count, stations);
  at_least(text, "%.0f", cold.per_cpu_minute, 600);
  at_least("as many others on the same floor after them", "%.0f", warm.per_cpu_minute, 1200);
  MissionPlanner one(kFast, {}), two(kFast, {});
  const double one_s = rate_of(one, items, 0, few, 1).wall_s, two_s = rate_of(two, items, 0, few, 2).wall_s;
  at_least("wall time with -j 1 over that with -j 2 (meaningless on a busy machine)", "%.2f", one_s / two_s,
           1.8);
}

void profiles(const Robot& robot) {
  std::vector<double> whole_ms, prepare_ms, solve_ms;
  std::mt19937 random(9);
  std::uniform_real_distribution<> across_m(-2.0, 2.0), slack(1.1, 1.6);
  for (int k = 0; k < 40; ++k) {
    ProfileRequest request{.piece = Curve({BezierSegment({{{0, 0}, {2, 0}, {4, across_m(random)}, {7, 1}}})}),
                           .plant = make_plant(robot),
                           .limits = *robot.limits,
                           .payload = {2.0, 2.0},
                           .solver = SolverChoice::fast};
    request.time.mode = TimeMode::minimum_time;
    request.time = {TimeMode::fixed_time, slack(random) * solve_profile(request).profile->duration_s()};
    double begin_ms = cpu_ms();
    const PreparedProblem prepared(request, 200);
    prepare_ms.push_back(cpu_ms() - begin_ms);
    begin_ms = cpu_ms();
    (void)nlp::solve_fast(prepared.problem, prepared.guess);
    solve_ms.push_back(cpu_ms() - begin_ms);
    if (k % 10 != 0) continue;
    request.nodes = 12800;
    request.draft = true;  // one grid of so many nodes: grid, transcription and solve
    begin_ms = cpu_ms();
    (void)solve_profile(request);
    whole_ms.push_back(cpu_ms() - begin_ms);
  }
  at_most("grid, transcription and solve at N = 12,800", "%.0f ms", median(whole_ms), 150);
  at_most("preparation (grid and transcription) at N = 200 over the solve", "%.1f times",
          median(prepare_ms) / median(solve_ms), 1.0);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::fputs("usage: bench_throughput MISSIONS HEADER\n", stderr), 2;
  const std::size_t count = std::stoul(argv[1]);
  const Robot robot = read_robot(kScenarios + "robots/nomad_super_scout.yaml");
  std::printf(
      "# Speed of planning\n\n%s\n\nCPU time of the process (one thread unless said otherwise), built-in "
      "solver; "
      "medians of 5 missions and of 40 curves. Missions are drawn at random over Nav2's warehouse with its "
      "keep-out mask; the payload is 5 kg, time is free. A kept answer is one about a leg that an earlier "
      "mission had.\n\n| figure | measured | aim | met |\n|---|---|---|---|\n",
      argv[2]);
  ten_legs(robot);
  demo();
  batches(count);
  profiles(robot);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("\nLargest memory of the process: %.0f MiB.\n", static_cast<double>(usage.ru_maxrss) / 1024);
}
