// How far the planner's paths are from the best that a brute-force search finds.
//
//   bench_ways search FLOOR FIRST LAST SEED   brute-force splines of poses FIRST to LAST as CSV
//   (reference.csv) bench_ways poses COUNT SEED               poses of the public set with their least known
//   energies as CSV bench_ways compare REFERENCE.csv NOTE     the planner on the same poses, as Markdown
//
// Both energies come from one evaluator: the path is driven by the planner's own profile solver, time free
// and standby counted.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>

#include "benchmarks/ways/brute_force.hpp"

namespace joulepath::ways {
namespace {

constexpr double kSame = 1e-4;  ///< relative, of two energies
constexpr double kFar = 0.01;   ///< excess from which a pose is listed

std::mt19937 random_of(unsigned seed, unsigned index) {
  std::seed_seq seeds{seed, index, 1U};
  return std::mt19937(seeds);
}

std::string pose_text(const Problem& p, int digits) {
  char text[300];
  std::snprintf(text, sizeof text, "%s,%.*g,%.*g,%.*g,%.*g,%.*g,%.*g", p.floor.c_str(), digits, p.start.x_m,
                digits, p.start.y_m, digits, p.start.heading_rad, digits, p.goal_m[0], digits, p.goal_m[1],
                digits, p.goal_heading_rad.value_or(NAN));
  return text;
}

void search(const std::string& floor, unsigned first, unsigned last, unsigned seed) {
  const World world = make_world(floor);
  for (unsigned index = first; index < last; ++index) {
    const Problem problem = random_problem(world, seed, index);
    std::mt19937 random = random_of(seed, index);
    const BestSpline best = brute_force(world, problem, random, {});
    std::printf("%u,%s,%.9g,%d,%s\n", index, pose_text(problem, 17).c_str(), best.energy_J, best.evaluations,
                std::isfinite(best.energy_J) ? spline_text(best.spline).c_str() : "");
    std::fflush(stdout);
  }
}

struct Reference {
  unsigned index{};
  Problem problem{};
  double best_J{};       ///< infinite: none was free
  std::string spline{};  ///< empty: not kept
};

std::vector<std::vector<std::string>> read_rows(const char* file) {
  std::ifstream in(file);
  std::vector<std::vector<std::string>> rows;
  std::string line;
  while (std::getline(in, line)) {
    std::vector<std::string>& field = rows.emplace_back(1, "");
    for (const char c : line) {
      if (c == ',')
        field.emplace_back();
      else
        field.back() += c;
    }
  }
  return rows;
}

/// From the floor on.
Problem problem_from(const std::vector<std::string>& row, std::size_t floor) {
  const auto number = [&](std::size_t k) { return std::stod(row.at(floor + k)); };
  Problem problem{
      .floor = row.at(floor), .start = {number(1), number(2), number(3)}, .goal_m = {number(4), number(5)}};
  if (row.at(floor + 6) != "nan") problem.goal_heading_rad = number(6);
  return problem;
}

std::vector<Reference> read_references(const char* file) {
  std::vector<Reference> all;
  std::vector<std::vector<std::string>> rows = read_rows(file);
  for (std::size_t k = 1; k < rows.size(); ++k) {
    rows[k].resize(11);
    all.push_back({static_cast<unsigned>(std::stoul(rows[k][0])), problem_from(rows[k], 1),
                   std::stod(rows[k][8]), rows[k][10]});
  }
  return all;
}

class Worlds {
 public:
  const World& of(const std::string& floor) {
    if (!worlds_.contains(floor)) worlds_.emplace(floor, make_world(floor));
    return worlds_.at(floor);
  }

 private:
  std::map<std::string, World> worlds_{};
};

/// Poses of the public set with their least known energy: that of the file, of the planner or of a search.
void poses(const char* file) {
  Worlds worlds;
  std::puts("floor,start_x_m,start_y_m,start_heading_rad,goal_x_m,goal_y_m,goal_heading_rad,best_J");
  const auto rows = read_rows(file);
  for (unsigned k = 1; k < rows.size(); ++k) {
    const Problem problem = problem_from(rows[k], 0);
    const World& world = worlds.of(problem.floor);
    std::mt19937 random = random_of(1, k);
    const BestSpline best = brute_force(world, problem, random, {.descents = 1});
    std::printf("%s,%.8g\n", pose_text(problem, 9).c_str(),
                std::min({best.energy_J, planned(world, problem).energy_J, std::stod(rows[k].at(7))}));
    std::fflush(stdout);
  }
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::lround(q * static_cast<double>(values.size() - 1)))];
}

struct Row {
  std::vector<double> excess_percent{}, plain_percent{};
  int worse_than_plain{}, failed{}, not_searched{}, better{}, turning{};
  std::vector<std::string> far{};
};

void judge(const World& world, const Reference& reference, Row& row) {
  const Problem& problem = reference.problem;
  const Answer ours = planned(world, problem);
  const double least_J = plain_J(world, problem);
  double best_J = reference.best_J;
  if (!reference.spline.empty())
    best_J = driven_J(world, problem, *free_spline_path(spline_from(reference.spline, problem)));
  row.not_searched += std::isinf(best_J);
  row.failed += std::isinf(ours.energy_J);
  if (std::isinf(ours.energy_J)) return;
  // Where the search found nothing better, the planner's path is the best known one.
  const double excess = ours.energy_J / std::min(best_J, ours.energy_J) - 1;
  row.excess_percent.push_back(100 * excess);
  row.better += ours.energy_J < best_J * (1 - kSame);
  row.turning += ours.turns;
  row.worse_than_plain += ours.energy_J > least_J * (1 + kSame);
  if (std::isfinite(least_J)) row.plain_percent.push_back(100 * (1 - ours.energy_J / least_J));
  if (excess < kFar) return;
  char text[200];
  std::snprintf(text, sizeof text, "| %s %u | %.1f m | %.2f J | %.2f J | %.1f %% | %s |\n",
                problem.floor.c_str(), reference.index, problem.reach_m(), ours.energy_J, best_J,
                100 * excess, ours.turns ? "turns in place" : "a curve");
  row.far.emplace_back(text);
}

void print(const std::map<std::string, Row>& rows, const char* note) {
  std::printf("# Paths against a brute-force search\n\n%s\n\n", note);
  std::puts(
      "Start and goal are 1 to 10 m apart; every second goal names a heading. Energy counts 10 W of standby; "
      "time is\nfree. The excess is over the best path known: that of the search, or the planner's own where "
      "that is better.\n\n| floor | poses | excess, median | p95 | max | planner better than the search | "
      "plans with a turn in place | saved against turn, line, turn: median | max | worse than that | not "
      "planned | search found nothing |\n|---|---|---|---|---|---|---|---|---|---|---|---|");
  for (const auto& [floor, row] : rows)
    std::printf("| %s | %zu | %.2f %% | %.2f %% | %.2f %% | %d | %d | %.1f %% | %.1f %% | %d | %d | %d |\n",
                floor.c_str(), row.excess_percent.size(), quantile(row.excess_percent, 0.5),
                quantile(row.excess_percent, 0.95), quantile(row.excess_percent, 1.0), row.better,
                row.turning, quantile(row.plain_percent, 0.5), quantile(row.plain_percent, 1.0),
                row.worse_than_plain, row.failed, row.not_searched);
  std::printf("\n## Poses that are more than %.0f %% above the best known\n\n", 100 * kFar);
  std::string far;
  for (const auto& [floor, row] : rows)
    for (const std::string& line : row.far) far += line;
  if (far.empty()) return void(std::puts("None."));
  std::puts("| pose | reach | planned | search | excess | the plan |\n|---|---|---|---|---|---|");
  std::fputs(far.c_str(), stdout);
}

void compare(const char* file, const char* note) {
  std::map<std::string, Row> rows;
  Worlds worlds;
  for (const Reference& reference : read_references(file)) {
    const std::string& floor = reference.problem.floor;
    judge(worlds.of(floor), reference, rows[floor]);
  }
  print(rows, note);
}

}  // namespace
}  // namespace joulepath::ways

int main(int argc, char** argv) {
  const auto number = [&](int k) { return static_cast<unsigned>(std::stoul(argv[k])); };
  if (argc == 6 && !std::strcmp(argv[1], "search"))
    joulepath::ways::search(argv[2], number(3), number(4), number(5));
  else if (argc == 3 && !std::strcmp(argv[1], "poses"))
    joulepath::ways::poses(argv[2]);
  else if (argc == 4 && !std::strcmp(argv[1], "compare"))
    joulepath::ways::compare(argv[2], argv[3]);
  else
    return std::fputs(
               "usage: bench_ways search FLOOR FIRST LAST SEED | poses POSES | compare REFERENCE NOTE\n",
               stderr),
           2;
  return 0;
}
