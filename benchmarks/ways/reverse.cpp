// What driving backward saves, and what it takes.
// usage: bench_ways_reverse COUNT SEED NOTE [KIND...]: plans with and without it as Markdown
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numeric>
#include <string>
#include <vector>

#include "benchmarks/ways/joint_cases.hpp"

namespace joulepath::ways {
namespace {

constexpr double kWorse = 5e-4;  ///< relative: a plan that is dearer by more is counted

struct Planned {
  double energy_J{}, cpu_s{};
};

Planned planned_case(const JointCase& one, bool with) {
  const PlanOptions options{.solver = SolverChoice::fast, .nodes = 200, .baselines = false};
  MissionWorld world = one.world->world;
  if (with) world.robot.limits->reverse_speed_m_s = world.robot.limits->speed_m_s;
  const std::clock_t before = std::clock();
  const Plan plan = plan_mission(one.mission, world, options, &one.world->space);
  const double cpu_s = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  const bool drives = plan.status == SolveStatus::optimal || plan.status == SolveStatus::feasible;
  return {drives ? plan.energy.total_J() : kNoLimit, cpu_s};
}

double at_share(std::vector<double> values, double share) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
}

/// Share of half the 90 % interval of a median about it, by the ranks of a binomial distribution.
double half_interval(std::size_t count) { return 1.645 * 0.5 / std::sqrt(static_cast<double>(count)); }

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::string percent(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%+.2f %%", value);
  return std::isnan(value) ? "-" : text;
}

void compare_kind(const JointFloors& floors, const std::string& kind, unsigned count, unsigned seed) {
  std::vector<double> change_percent, before_s, after_s;
  int new_ones = 0, lost = 0, none = 0, dearer = 0;
  for (unsigned index = 0; index < count; ++index) {
    const JointCase one = joint_case(floors, kind, seed, index);
    const Planned before = planned_case(one, false), after = planned_case(one, true);
    before_s.push_back(before.cpu_s);
    after_s.push_back(after.cpu_s);
    const bool had = std::isfinite(before.energy_J), has = std::isfinite(after.energy_J);
    none += !had && !has;
    new_ones += !had && has;
    lost += had && !has;
    if (std::getenv("JOULEPATH_BENCH_CASES"))
      std::fprintf(stderr, "%s %.3f -> %.3f J (%+.2f %%), %.2f -> %.2f s\n", one.name.c_str(),
                   before.energy_J, after.energy_J, 100 * (after.energy_J / before.energy_J - 1),
                   before.cpu_s, after.cpu_s);
    if (!had || !has) continue;
    change_percent.push_back(100 * (after.energy_J / before.energy_J - 1));
    dearer += after.energy_J > before.energy_J * (1 + kWorse);
  }
  const double wide = half_interval(change_percent.size());
  const auto share = [&](double at) { return percent(at_share(change_percent, std::clamp(at, 0.0, 1.0))); };
  const std::vector<std::string> cells{
      kind,
      std::to_string(change_percent.size()),
      percent(mean(change_percent)),
      share(0.5) + " (" + share(0.5 - wide) + " to " + share(0.5 + wide) + ")",
      share(0),
      share(1),
      std::to_string(dearer),
      std::to_string(none) + " / " + std::to_string(new_ones) + " / " + std::to_string(lost)};
  for (const std::string& cell : cells) std::printf("| %s ", cell.c_str());
  std::printf("| %.2f s | %.2f s |\n", mean(before_s), mean(after_s));
  std::fflush(stdout);
}

void compare_all(unsigned count, unsigned seed, const char* note, const std::vector<std::string>& kinds) {
  std::printf(
      "# Driving backward\n\n%s\n\nEach case is planned for a robot that a search never drives backward and "
      "for "
      "the same with `limits: {reverse_speed_m_s}` equal to its speed; 10 W of standby, time is free.\nKinds "
      "of "
      "cases: `benchmarks/ways/joint_cases.hpp`.\n\n",
      note);
  std::puts(
      "| cases | planned by both | energy, mean | median (90 % interval) | best | worst | dearer by 0.05 % "
      "or more | planned "
      "by none / only with / only without | CPU each without | with "
      "|\n|---|---|---|---|---|---|---|---|---|---|");
  const JointFloors floors;
  for (const std::string& kind : kinds) compare_kind(floors, kind, count, seed);
}

}  // namespace
}  // namespace joulepath::ways

int main(int argc, char** argv) {
  if (argc < 4) return std::fputs("usage: bench_ways_reverse COUNT SEED NOTE [KIND...]\n", stderr), 2;
  std::vector<std::string> kinds(argv + 4, argv + argc);
  if (kinds.empty()) kinds = joulepath::ways::joint_kinds();
  joulepath::ways::compare_all(static_cast<unsigned>(std::stoul(argv[1])),
                               static_cast<unsigned>(std::stoul(argv[2])), argv[3], kinds);
  return 0;
}
