// Profiles under a jerk limit on seeded random problems of four robots: CPU time of this process, agreement
// of the two solvers, limits between the nodes, the cost of the limit, and classic profiles that keep it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "benchmarks/support/cpu_time.hpp"
#include "model/limit_table.hpp"
#include "planner/baselines/baseline.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/motion/replay.hpp"
#include "planner/nlp/fast/jerk_fast_solver.hpp"
#include "planner/nlp/ipopt/ipopt_solver.hpp"
#include "planner/profile/profile_solver.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "tests/support/random_profiles.hpp"

namespace joulepath {
namespace {

constexpr unsigned kSeed = 20261122;
constexpr std::size_t kPlainNodes = 200;
constexpr TimeMode kModes[] = {TimeMode::free_time, TimeMode::time_budget, TimeMode::fixed_time,
                               TimeMode::time_price};

/// A robot file, and the jerk limit of its problems if the file has none.
struct Source {
  const char* file;
  double jerk_m_s3;
};
constexpr Source kRobots[] = {
    {"nomad_super_scout", 1.0}, {"kobuki", 1.0}, {"amr_150kg", 0}, {"tug_600kg", 0}};

template <class Work>
double timed_ms(Work&& work) {
  const double before_ms = cpu_ms();
  work();
  return cpu_ms() - before_ms;
}

struct Sample {
  std::vector<double> values{};
  void add(double value) { values.push_back(value); }
  double share(double q) {
    if (values.empty()) return std::nan("");
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
  }
};

/// Single programs, without refinement and check.
struct Programs {
  int unsolved{};
  Sample fast_ms{}, ipopt_ms{}, difference{};
};

struct Group {
  int problems{}, unsolved{}, handed_over{}, broken{}, baselines{}, compared{};
  Programs plain{}, refined{};
  Sample fast_ms{}, ipopt_ms{}, difference{}, violation{};
  Sample energy_price{}, time_price{}, tuned{}, s_curve{};
};

Limits kobuki_limits() {
  Limits limits;
  limits.speed_m_s = 0.65, limits.acceleration_m_s2 = limits.deceleration_m_s2 = 0.8;
  limits.yaw_rate_rad_s = 1.9, limits.yaw_acceleration_rad_s2 = 3, limits.lateral_acceleration_m_s2 = 0.5;
  return limits;
}

ProfileRequest next_request(const Source& source, testing::RandomProfiles& random, int index) {
  Robot robot = read_robot("scenarios/robots/" + std::string(source.file) + ".yaml");
  if (!robot.limits) robot.limits = kobuki_limits();
  ProfileRequest request = random.next(testing::kPathClasses[index % 4]);
  const double most_kg = std::min(robot.limits->max_payload_kg, 0.5 * robot.inertia.chassis_mass_kg);
  const double payload_kg = most_kg * random.uniform(0, 1);
  request.plant = make_plant(robot);
  request.payload = {payload_kg, payload_kg};
  request.limits = limits_for_payload(robot, payload_kg);
  if (source.jerk_m_s3 > 0) request.limits.jerk_m_s3 = source.jerk_m_s3;
  request.solver = SolverChoice::fast;
  return request;
}

ProfileRequest without_jerk(ProfileRequest request) {
  request.limits.jerk_m_s3 = kNoLimit;
  return request;
}

double value_J(const ProfileRequest& request, const Profile& profile) {
  const bool priced = request.time.mode == TimeMode::time_price;
  return replay(request, profile).energy_J + (priced ? request.time.price_W * profile.duration_s() : 0.0);
}

/// One program on the grid of the profile without the limit, from that profile averaged over time.
void look_at_grid(const ProfileRequest& request, const Profile& free, Programs& programs) {
  const PathMotion motion = path_motion(request);
  const nlp::Problem problem = nlp::transcribe(request, motion, free.s, {}, &free);
  double most = 0;
  for (double a : free.acceleration) most = std::max(most, std::abs(a));
  const double window_s = std::min(most / request.limits.jerk_m_s3, 0.5 * free.duration_s());
  const nlp::JerkProgram program(problem, {}, nlp::averaged_motion(free, window_s));
  nlp::JerkSolution fast, ipopt;
  programs.fast_ms.add(timed_ms([&] { fast = nlp::solve_fast(program); }));
  programs.ipopt_ms.add(timed_ms([&] { ipopt = nlp::solve_with_ipopt(program); }));
  if (!fast.converged || !ipopt.converged) {
    programs.unsolved += !fast.converged;
    return;
  }
  programs.difference.add(std::abs(fast.objective / ipopt.objective - 1));
}

/// Largest |change of acceleration over time| and the worst use of any limit at 64 places of each segment.
bool broken_between_nodes(const ProfileRequest& request, const Profile& profile) {
  constexpr double kTolerance = 1e-6;
  constexpr int kPlaces = 64;
  double before = 0;
  for (std::size_t k = 0; k + 1 < profile.time_s.size(); ++k) {
    const double dt = (profile.time_s[k + 1] - profile.time_s[k]) / kPlaces;
    for (int i = 0; i < kPlaces; ++i) {
      const double a = profile.acceleration[k] + profile.jerk[k] * (i + 1) * dt;
      if (std::abs(a - before) > request.limits.jerk_m_s3 * dt * (1 + kTolerance) + 1e-9) return true;
      before = a;
    }
  }
  return !replay(request, profile).valid();
}

void look_at_baselines(const ProfileRequest& request, const Profile& plan, Group& group) {
  const double T = plan.duration_s(), plan_J = replay(request, plan).energy_J;
  ++group.compared;
  const BaselineResult tuned = trapezoid_best_tuned(request, T);
  const BaselineResult largest = trapezoid_max_acceleration(request, T);
  group.baselines += tuned.feasible;
  if (tuned.feasible) group.tuned.add(tuned.energy_J / plan_J - 1);
  if (largest.feasible) group.s_curve.add(largest.energy_J / plan_J - 1);
}

void look(ProfileRequest request, TimeGoal goal, double slower, Group& group) {
  ++group.problems;
  ProfileRequest fastest = request;
  fastest.time = {.mode = TimeMode::minimum_time};
  const ProfileResult least = solve_profile(fastest), least_free = solve_profile(without_jerk(fastest));
  if (!least.profile || !least_free.profile) {
    ++group.unsolved;
    return;
  }
  group.time_price.add(least.profile->duration_s() / least_free.profile->duration_s() - 1);
  if (goal.mode == TimeMode::time_budget || goal.mode == TimeMode::fixed_time)
    goal.duration_s = slower * least.profile->duration_s();
  request.time = goal;
  ProfileResult fast, ipopt;
  group.fast_ms.add(timed_ms([&] { fast = solve_profile(request); }));
  ProfileRequest settled = request;
  settled.solver = SolverChoice::ipopt;
  group.ipopt_ms.add(timed_ms([&] { ipopt = solve_profile(settled); }));
  if (!fast.profile || !ipopt.profile) {
    ++group.unsolved;
    return;
  }
  group.handed_over += !fast.summary.handed_over.empty();
  group.broken += broken_between_nodes(request, *fast.profile);
  group.difference.add(std::abs(value_J(request, *fast.profile) / value_J(request, *ipopt.profile) - 1));
  ProfileRequest same_time = without_jerk(request);
  same_time.time = {.mode = TimeMode::time_budget, .duration_s = fast.profile->duration_s()};
  const ProfileResult free = solve_profile(same_time);
  if (!free.profile) return;
  group.energy_price.add(replay(request, *fast.profile).energy_J / replay(same_time, *free.profile).energy_J -
                         1);
  request.time.duration_s = std::max(request.time.duration_s, free.profile->duration_s());
  look_at_grid(request, *free.profile, group.refined);
  same_time.time.duration_s = request.time.duration_s;
  same_time.nodes = kPlainNodes;
  same_time.draft = true;  // one grid
  const ProfileResult plain = solve_profile(same_time);
  if (plain.profile) look_at_grid(request, *plain.profile, group.plain);
  look_at_baselines(request, *fast.profile, group);
}

std::string format(const char* pattern, auto... values) {
  char text[500];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

void write_programs(std::ofstream& out, const char* title, Programs Group::*which,
                    std::map<std::string, Group>& groups) {
  out << "## One program (" << title
      << ")\n\n"
         "| robot, path | problems | not solved | fast: median, p95 ms | Ipopt: median, p95 ms | relative "
         "difference of the objective: max |\n|---|---|---|---|---|---|\n";
  Programs all;
  const auto row = [&](const std::string& name, Programs& p) {
    out << format("| %s | %zu | %d | %.1f, %.1f | %.0f, %.0f | %.0e |\n", name.c_str(),
                  p.fast_ms.values.size(), p.unsolved, p.fast_ms.share(0.5), p.fast_ms.share(0.95),
                  p.ipopt_ms.share(0.5), p.ipopt_ms.share(0.95), p.difference.share(1));
  };
  for (auto& [name, group] : groups) {
    Programs& own = group.*which;
    row(name, own);
    all.unsolved += own.unsolved;
    for (Sample Programs::*sample : {&Programs::fast_ms, &Programs::ipopt_ms, &Programs::difference})
      for (double value : (own.*sample).values) (all.*sample).add(value);
  }
  row("all", all);
  out << '\n';
}

void write(std::ofstream& out, std::map<std::string, Group>& groups) {
  write_programs(out, "200 nodes", &Group::plain, groups);
  write_programs(out, "on the refined grid of the profile without the limit: 200 to some 800 nodes",
                 &Group::refined, groups);
  out << "## Whole profiles (grid, limits between nodes, bound)\n\n"
         "| robot, path | problems | none found | handed over | limit exceeded between nodes | `--solver "
         "fast`: "
         "median, p95 ms | default: median, p95 ms | relative difference of the value: median, max |\n"
         "|---|---|---|---|---|---|---|---|\n";
  for (auto& [name, g] : groups)
    out << format("| %s | %d | %d | %d | %d | %.0f, %.0f | %.0f, %.0f | %.0e, %.0e |\n", name.c_str(),
                  g.problems, g.unsolved, g.handed_over, g.broken, g.fast_ms.share(0.5),
                  g.fast_ms.share(0.95), g.ipopt_ms.share(0.5), g.ipopt_ms.share(0.95),
                  g.difference.share(0.5), g.difference.share(1));
  out << "\n## The price of jerk, and classic profiles that keep the limit\n\n"
         "Energy at the same time and least time, against the same problem without the limit; total energy "
         "(standby included) of rounded trapezoids (S-curves) in the plan's time, against the plan.\n\n"
         "| robot, path | energy: median, max | least time: median, max | best tuned: found | above the "
         "plan: "
         "median, max | largest acceleration, above the plan: median, max |\n|---|---|---|---|---|---|\n";
  for (auto& [name, g] : groups)
    out << format(
        "| %s | %.2f %%, %.2f %% | %.1f %%, %.1f %% | %d of %d | %.2f %%, %.2f %% | %.2f %%, %.2f %% |\n",
        name.c_str(), 100 * g.energy_price.share(0.5), 100 * g.energy_price.share(1),
        100 * g.time_price.share(0.5), 100 * g.time_price.share(1), g.baselines, g.compared,
        100 * g.tuned.share(0.5), 100 * g.tuned.share(1), 100 * g.s_curve.share(0.5),
        100 * g.s_curve.share(1));
}

int run(const char* file, int count, const char* how) {
  testing::RandomProfiles random(kSeed);
  std::map<std::string, Group> groups;
  for (const Source& source : kRobots)
    for (int i = 0; i < count; ++i) {
      const ProfileRequest request = next_request(source, random, i);
      const TimeGoal goal{kModes[random.choice(4)], kNoLimit, random.uniform(0.1, 20)};
      const double slower = random.uniform(1.02, 2);
      const std::string name = std::string(source.file) + ", " + testing::kPathClassNames[i % 4];
      look(request, goal, slower, groups[name]);
      std::fprintf(stderr, "%s %d\n", source.file, i + 1);
    }
  std::ofstream out(file);
  out << "# Profiles under a jerk limit\n\n"
      << how << " CPU time of one process; the machine was shared with other work.\n\n";
  write(out, groups);
  return 0;
}

}  // namespace
}  // namespace joulepath

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  return joulepath::run(argv[1], std::atoi(argv[2]), argv[3]);
}
