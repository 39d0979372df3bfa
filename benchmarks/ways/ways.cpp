// How far the planner's paths are from the best that a brute-force search finds.
//
//   bench_ways search COUNT SEED STARTS     poses with their brute-force energies as CSV (reference.csv)
//   bench_ways poses COUNT SEED STARTS      poses of the public set with their least known energies as CSV
//   bench_ways compare REFERENCE.csv NOTE   the planner on the same poses, as Markdown
//
// Both energies come from one evaluator: the path is driven by the planner's own profile solver, time free
// and standby counted. The search is the benchmark's own: random starts, then Nelder-Mead.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <nlopt.hpp>
#include <numbers>
#include <random>
#include <sstream>

#include "planner/mission/mission.hpp"
#include "planner/path/shape/free_spline.hpp"
#include "planner/ways/way_score.hpp"
#include "scenarios/map_file.hpp"
#include "scenarios/robot_file.hpp"
#include "tests/planner/path/grids.hpp"

namespace {

using namespace joulepath;

struct Problem {
  std::string floor{};
  Pose start{};
  Point2 goal_m{};
  std::optional<double> goal_heading_rad{};
};

struct World {
  std::string name{};
  MissionWorld world{};
  RouteSpace space;
};

World make_world(const std::string& name) {
  MissionWorld world{.robot = read_robot("scenarios/robots/nomad_super_scout.yaml")};
  world.map = name == "empty" ? free_grid(600, 600, 0.05) : read_map("scenarios/maps/" + name + ".yaml");
  RouteSpace space(*world.map, nullptr, world.robot.footprint, 0.05);
  return {name, std::move(world), std::move(space)};
}

MissionRequest mission_of(const Problem& problem) {
  MissionRequest mission{.name = "pose", .clearance_m = 0.05};
  mission.stations["goal"] = {
      .x_m = problem.goal_m[0], .y_m = problem.goal_m[1], .heading_rad = problem.goal_heading_rad};
  mission.start.pose = problem.start;
  mission.legs = {{.to = "goal"}};
  return mission;
}

double energy_J(const Plan& plan) {
  const bool drives = plan.status == SolveStatus::optimal || plan.status == SolveStatus::feasible;
  return drives ? plan.energy.total_J() : kNoLimit;
}

double planned_J(const World& world, const MissionRequest& mission) {
  const PlanOptions options{.solver = SolverChoice::fast, .nodes = 200, .baselines = false};
  return energy_J(plan_mission(mission, world.world, options, &world.space));
}

double driven_J(const World& world, const Problem& problem, const Path& path) {
  MissionRequest mission = mission_of(problem);
  mission.legs = {{.to = "goal", .path = PathRequest{.ready = path}}};
  return planned_J(world, mission);
}

/// Turn, line, turn: what a plain controller does; infinite where the line is not free.
double plain_J(const World& world, const Problem& problem) {
  const double dx = problem.goal_m[0] - problem.start.x_m, dy = problem.goal_m[1] - problem.start.y_m;
  const double bearing_rad = std::atan2(dy, dx);
  Path path;
  append_turn_to(path, problem.start, bearing_rad);
  path.pieces.push_back(
      straight_piece({problem.start.x_m, problem.start.y_m, bearing_rad}, std::hypot(dx, dy)));
  if (problem.goal_heading_rad) append_turn_to(path, path.end(), *problem.goal_heading_rad);
  if (world.space.checker().first_collision(path)) return kNoLimit;
  return driven_J(world, problem, path);
}

/// 1 to 10 m apart, log-uniform; every second goal with a heading.
Problem random_problem(const World& world, std::mt19937& random, std::size_t index) {
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<>(from, to)(random);
  };
  const auto extent = world.space.field().extent_m();
  while (true) {
    Problem problem{.floor = world.name};
    problem.start = {uniform(extent.x_min_m, extent.x_max_m), uniform(extent.y_min_m, extent.y_max_m),
                     uniform(-std::numbers::pi, std::numbers::pi)};
    const double reach_m = std::exp(uniform(0.0, std::log(10.0)));
    const double bearing_rad = uniform(-std::numbers::pi, std::numbers::pi);
    const double heading_rad = uniform(-std::numbers::pi, std::numbers::pi);
    problem.goal_m = {problem.start.x_m + reach_m * std::cos(bearing_rad),
                      problem.start.y_m + reach_m * std::sin(bearing_rad)};
    if (index % 2 == 1) problem.goal_heading_rad = heading_rad;
    const FreeSpace& floor = world.space.any_heading();
    const auto free = [&](double x_m, double y_m) {
      return x_m > extent.x_min_m + 1 && x_m < extent.x_max_m - 1 && y_m > extent.y_min_m + 1 &&
             y_m < extent.y_max_m - 1 && world.space.field().disc_free(x_m, y_m, floor.radius_m() + 0.01);
    };
    if (free(problem.start.x_m, problem.start.y_m) && free(problem.goal_m[0], problem.goal_m[1]) &&
        floor.connected({problem.start.x_m, problem.start.y_m}, problem.goal_m))
      return problem;
  }
}

/// Random splines of one to three spans, each taken down by Nelder-Mead twice.
class BruteForce {
 public:
  BruteForce(const World& world, const Problem& problem, std::mt19937& random)
      : world_(world), problem_(problem), random_(random), plant_(make_plant(world.world.robot)) {}

  double search(int starts) {
    for (int k = 0; k < starts; ++k) {
      spans_ = 1 + static_cast<std::size_t>(k % 3);
      std::vector<double> x = random_start();
      descend(x, 0.15, 400);
      descend(x, 0.03, 300);
    }
    std::sort(best_.begin(), best_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    double best_J = kNoLimit;
    for (std::size_t k = 0; k < std::min<std::size_t>(5, best_.size()); ++k)
      best_J = std::min(best_J, driven_J(world_, problem_, *free_spline_path(best_[k].second)));
    return best_J;
  }

 private:
  double reach_m() const {
    return std::hypot(problem_.goal_m[0] - problem_.start.x_m, problem_.goal_m[1] - problem_.start.y_m);
  }
  std::vector<double> random_start() {
    const auto uniform = [&](double from, double to) {
      return std::uniform_real_distribution<>(from, to)(random_);
    };
    const double dx = problem_.goal_m[0] - problem_.start.x_m, dy = problem_.goal_m[1] - problem_.start.y_m;
    std::vector<double> x{std::log(reach_m()) + uniform(-4.5, 0.0), std::log(reach_m()) + uniform(-4.5, 0.0)};
    if (!problem_.goal_heading_rad) x.push_back(std::atan2(dy, dx) + uniform(-2.5, 2.5));
    for (std::size_t k = 1; k < spans_; ++k) {
      const double share = uniform(0.0, 1.0), spread_m = 0.4 * reach_m();
      x.push_back(problem_.start.x_m + share * dx + uniform(-spread_m, spread_m));
      x.push_back(problem_.start.y_m + share * dy + uniform(-spread_m, spread_m));
    }
    return x;
  }
  FreeSpline spline(const std::vector<double>& x) const {
    FreeSpline spline{.points_m = {{problem_.start.x_m, problem_.start.y_m}},
                      .start_heading_rad = problem_.start.heading_rad,
                      .start_handle_m = std::exp(x[0]),
                      .goal_handle_m = std::exp(x[1])};
    std::size_t i = 2;
    spline.goal_heading_rad = problem_.goal_heading_rad ? *problem_.goal_heading_rad : x[i++];
    for (; i + 1 < x.size(); i += 2) spline.points_m.push_back({x[i], x[i + 1]});
    spline.points_m.push_back(problem_.goal_m);
    return spline;
  }
  double cost(const std::vector<double>& x) const {
    const std::optional<Path> path = free_spline_path(spline(x));
    if (!path) return 1e6;
    const double slack_m = world_.space.checker().least_slack_m(*path);
    if (slack_m < 0) return 1e5 - slack_m;
    const MissionRequest mission = mission_of(problem_);
    const PlanOptions options{};
    const PathScore score =
        score_path(*path, mission.legs[0], 0, {mission, world_.world, nullptr, plant_, options, 0.0});
    return score.drivable ? score.energy_J : 1e6;
  }
  void descend(std::vector<double>& x, double step, int evaluations) {
    nlopt::opt optimizer(nlopt::LN_NELDERMEAD, static_cast<unsigned>(x.size()));
    optimizer.set_initial_step(step * std::max(1.0, reach_m()));
    optimizer.set_ftol_rel(1e-7);
    optimizer.set_maxeval(evaluations);
    optimizer.set_min_objective([](const std::vector<double>& at, std::vector<double>&,
                                   void* self) { return static_cast<BruteForce*>(self)->cost(at); },
                                this);
    double value = 0;
    optimizer.optimize(x, value);
    const auto path = free_spline_path(spline(x));
    if (value < 1e4 && path && !world_.space.checker().first_collision(*path))
      best_.emplace_back(value, spline(x));
  }

  const World& world_;
  const Problem& problem_;
  std::mt19937& random_;
  Plant plant_;
  std::size_t spans_{1};
  std::vector<std::pair<double, FreeSpline>> best_{};
};

void search(int count, unsigned seed, int starts) {
  std::puts("floor,start_x_m,start_y_m,start_heading_rad,goal_x_m,goal_y_m,goal_heading_rad,plain_J,best_J");
  for (const std::string name : {"empty", "warehouse", "depot"}) {
    const World world = make_world(name);
    std::mt19937 random(seed);
    for (int k = 0; k < (name == "empty" ? count : count / 2); ++k) {
      const Problem p = random_problem(world, random, static_cast<std::size_t>(k));
      std::mt19937 own(seed + 1000 + static_cast<unsigned>(k));
      const double best_J = BruteForce(world, p, own).search(starts);
      std::printf("%s,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.9g,%.9g\n", name.c_str(), p.start.x_m,
                  p.start.y_m, p.start.heading_rad, p.goal_m[0], p.goal_m[1],
                  p.goal_heading_rad.value_or(NAN), plain_J(world, p), best_J);
      std::fflush(stdout);
    }
  }
}

/// Poses on the two committed floors with the least energy that the planner or a short search finds.
void poses(std::size_t count, unsigned seed, int starts) {
  std::puts("floor,start_x_m,start_y_m,start_heading_rad,goal_x_m,goal_y_m,goal_heading_rad,best_J");
  for (const std::string name : {"warehouse", "depot"}) {
    const World world = make_world(name);
    std::mt19937 random(seed);
    for (std::size_t k = 0; k < count / 2; ++k) {
      const Problem p = random_problem(world, random, k);
      std::mt19937 own(seed + 1000 + static_cast<unsigned>(k));
      const double best_J =
          std::min(planned_J(world, mission_of(p)), BruteForce(world, p, own).search(starts));
      std::printf("%s,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.8g\n", name.c_str(), p.start.x_m, p.start.y_m,
                  p.start.heading_rad, p.goal_m[0], p.goal_m[1], p.goal_heading_rad.value_or(NAN), best_J);
      std::fflush(stdout);
    }
  }
}

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::lround(q * static_cast<double>(values.size() - 1)))];
}

struct Row {
  std::vector<double> excess_percent{}, plain_percent{};
  int worse_than_plain{}, failed{};
};

void compare(const std::string& file, const std::string& note) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  std::map<std::string, Row> rows;
  std::map<std::string, World> worlds;
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    Problem p;
    std::string heading, plain, best;
    fields >> p.floor >> p.start.x_m >> p.start.y_m >> p.start.heading_rad >> p.goal_m[0] >> p.goal_m[1] >>
        heading >> plain >> best;
    if (heading != "nan") p.goal_heading_rad = std::stod(heading);
    const double plain_J = std::stod(plain), best_J = std::stod(best);
    const World& world = worlds.try_emplace(p.floor, make_world(p.floor)).first->second;
    const double ours_J = planned_J(world, mission_of(p));
    Row& row = rows[p.floor];
    if (!std::isfinite(ours_J)) {
      ++row.failed;
      continue;
    }
    // Where the search itself found nothing better, the planner's path is the best known.
    row.excess_percent.push_back(100 * (ours_J / std::min(best_J, ours_J) - 1));
    row.worse_than_plain += ours_J > plain_J * (1 + 1e-4);
    if (std::isfinite(plain_J)) row.plain_percent.push_back(100 * (1 - ours_J / plain_J));
  }
  std::printf("# Paths against a brute-force search\n\n%s\n\n", note.c_str());
  std::printf(
      "Start and goal are 1 to 10 m apart; every second goal names a heading. Energy counts 10 W of standby; "
      "time is\n"
      "free. The excess is over the best path known: that of the search, or the planner's own where that is "
      "better.\n\n"
      "| floor | poses | excess, median | p95 | max | saved against turn, line, turn: median | max | worse "
      "than "
      "that | not planned |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const auto& [floor, row] : rows)
    std::printf("| %s | %zu | %.2f %% | %.2f %% | %.2f %% | %.1f %% | %.1f %% | %d | %d |\n", floor.c_str(),
                row.excess_percent.size(), quantile(row.excess_percent, 0.5),
                quantile(row.excess_percent, 0.95), quantile(row.excess_percent, 1.0),
                quantile(row.plain_percent, 0.5), quantile(row.plain_percent, 1.0), row.worse_than_plain,
                row.failed);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 5 && !std::strcmp(argv[1], "search")) {
    search(std::atoi(argv[2]), static_cast<unsigned>(std::atoi(argv[3])), std::atoi(argv[4]));
    return 0;
  }
  if (argc == 5 && !std::strcmp(argv[1], "poses")) {
    poses(std::stoul(argv[2]), static_cast<unsigned>(std::atoi(argv[3])), std::atoi(argv[4]));
    return 0;
  }
  if (argc == 4 && !std::strcmp(argv[1], "compare")) {
    compare(argv[2], argv[3]);
    return 0;
  }
  std::fputs(
      "usage: bench_ways search COUNT SEED STARTS | poses COUNT SEED STARTS | compare REFERENCE.csv NOTE\n",
      stderr);
  return 2;
}
