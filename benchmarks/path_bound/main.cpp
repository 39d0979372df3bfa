// Attempts to beat the bound over all paths, and its distance from the best known paths.
// usage: bench_path_bound OUT MOTIONS NOTE
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

#include "benchmarks/path_bound/judge_robot.hpp"
#include "benchmarks/support/cpu_time.hpp"
#include "benchmarks/ways/joint_cases.hpp"
#include "benchmarks/ways/poses.hpp"
#include "planner/bound/path_bound.hpp"
#include "planner/mission/mission.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath::path_bound {
namespace {

constexpr double kWays_m[] = {0.3, 0.7, 1.5, 2.6, 4.0, 10.0};

std::string text(double value, int digits) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.*f", digits, value);
  return buffer;
}

/// What the aims are about; of several floors, lengths or lines the worst.
struct Findings {
  long below{};  ///< energies below a bound, of all parts
  double open_percent{}, open_95_percent{}, maps_percent{}, leg_ms{}, line_J{}, table_ms{};
};

/// Each measured figure beside what was asked and what counts as a failure.
void write_aims(std::ostream& out, const Findings& found) {
  struct Aim {
    const char *what, *unit;
    double measured, asked, fails;
    int digits;
  };
  const Aim aims[] = {{"energies below a bound", "", static_cast<double>(found.below), 0, 1, 0},
                      {"gap on an open floor, median", " %", found.open_percent, 4, 6, 1},
                      {"the same, 95 %", " %", found.open_95_percent, 12, 18, 1},
                      {"gap between obstacles, median", " %", found.maps_percent, 9, 12, 1},
                      {"energy of a straight line less its bound", " J", found.line_J, 0.7, kNoLimit, 2},
                      {"CPU of a leg, median", " ms", found.leg_ms, 30, 500, 0},
                      {"CPU of a table", " ms", found.table_ms, 1000, kNoLimit, 0}};
  out << "## Aims\n\nOf floors, lines and tables the worst. Gaps are those of the poses below. What headings "
         "leave is the turning itself: the bound knows a heading, not the yaw rate by which a robot comes to "
         "it ([nlp.md](../../docs/nlp.md)).\n\n| figure | measured | asked, at most | fails at | outcome "
         "|\n|---|---:|---:|---:|---|\n";
  for (const auto& [what, unit, measured, asked, fails, digits] : aims)
    out << "| " << what << " | " << text(measured, digits) << unit << " | "
        << text(asked, asked < 1 ? digits : 0) << unit << " | "
        << (fails < kNoLimit ? text(fails, 0) + unit : "-") << " | "
        << (measured <= asked  ? "met"
            : measured < fails ? "short"
                               : "failed")
        << " |\n";
  out << '\n';
}

struct Tally {
  long judged{}, exceptions{};
  double least_percent{kNoLimit};
  void add(double energy_J, double bound_J) {
    ++judged;
    exceptions += energy_J < bound_J;
    least_percent = std::min(least_percent, 100 * (energy_J / bound_J - 1));
  }
};

/// Judged motions of one robot, by their kind; bounds at the motion's own length.
void judge(const Robot& robot, double payload_kg, int motions, unsigned seed,
           std::map<std::string, Tally>& by_kind, Tally& all) {
  const PowerForm form = power_form(make_plant(robot), *robot.limits, payload_kg);
  const JudgeRobot judge = judge_robot(robot, *robot.limits, payload_kg);
  std::mt19937 random(seed);
  for (const double way_m : kWays_m) {
    const LineBound bound = line_bound(form, way_m, 0.0);
    const auto add = [&](const Motion& motion) {
      const Driven driven = drive(judge, motion);
      if (!driven.within_limits || driven.way_m < way_m) return;
      if (!form.reverse && drives_backward(motion)) return;
      by_kind[motion.kind.substr(0, motion.kind.find(','))].add(driven.energy_J, bound.at(driven.way_m));
      all.add(driven.energy_J, bound.at(driven.way_m));
    };
    for (const Motion& motion : worst_motions(judge, way_m * 1.0002)) add(motion);
    for (int k = 0; k < motions; ++k) add(random_motion(judge, way_m * 1.001, random));
  }
}

void write_motions(std::ostream& out, int motions, Findings& found) {
  const Robot nomad = read_robot("scenarios/robots/nomad_super_scout.yaml");
  std::map<std::string, Tally> by_kind;
  Tally all;
  out << "## Motions made by other code\n\n"
      << "Random and constructed motions, driven by an integrator and a power model that share nothing with "
         "the product, against the bound at "
         "their own length.\n\n| robot | motions | below the bound | least margin |\n|---|---:|---:|---:|\n";
  unsigned seed = 1;
  for (const Variant& variant : kVariants) {
    Tally one;
    const int each = motions / static_cast<int>(std::size(kVariants) * std::size(kWays_m));
    judge(robot_of(nomad, variant), variant.payload_kg, each, seed++, by_kind, one);
    out << "| " << variant.name << " | " << one.judged << " | " << one.exceptions << " | "
        << text(one.least_percent, 2) << " % |\n";
    all.judged += one.judged, all.exceptions += one.exceptions,
        all.least_percent = std::min(all.least_percent, one.least_percent);
  }
  out << "| all | " << all.judged << " | " << all.exceptions << " | " << text(all.least_percent, 2)
      << " % |\n\n"
      << "| kind | motions | below the bound | least margin |\n|---|---:|---:|---:|\n";
  for (const auto& [kind, one] : by_kind)
    out << "| " << kind << " | " << one.judged << " | " << one.exceptions << " | "
        << text(one.least_percent, 2) << " % |\n";
  found.below += all.exceptions;
}

struct KnownPose {
  ways::Problem problem{};
  double best_J{};
};

std::vector<KnownPose> reference_poses() {
  std::ifstream file("benchmarks/ways/reference.csv");
  std::string line;
  std::getline(file, line);
  std::vector<KnownPose> poses;
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::string index, floor, word;
    double value[7];
    words >> index >> floor;
    for (double& x : value) words >> word, x = std::strtod(word.c_str(), nullptr);
    if (!std::isfinite(value[6])) continue;
    KnownPose pose{{.floor = floor, .start = {value[0], value[1], value[2]}, .goal_m = {value[3], value[4]}},
                   value[6]};
    if (std::isfinite(value[5])) pose.problem.goal_heading_rad = value[5];
    poses.push_back(pose);
  }
  return poses;
}

double share(std::vector<double> values, double at) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::lround(at * static_cast<double>(values.size() - 1)))];
}

/// Each motion against the bound between its own poses, whatever its length.
void write_own_poses(std::ostream& out, int motions, Findings& found) {
  const Robot nomad = read_robot("scenarios/robots/nomad_super_scout.yaml");
  out << "\n## Motions between their own poses\n\nThe same kinds of motions against the bound for their ends "
         "and "
         "headings, over all lengths.\n\n| robot | motions | below the bound | least margin | raised by "
         "headings, mean |\n|---|---:|---:|---:|---:|\n";
  unsigned seed = 100;
  for (const Variant& variant : kVariants) {
    const Robot robot = robot_of(nomad, variant);
    const Limits limits = limits_along(robot, {variant.payload_kg, variant.payload_kg});
    const JudgeRobot judge = judge_robot(robot, limits, variant.payload_kg);
    const Plant plant = make_plant(robot);
    LegBounds bounds(plant, robot, nullptr);
    std::mt19937 random(seed++);
    Tally one;
    double raised_percent = 0;
    while (one.judged * static_cast<long>(std::size(kVariants)) < motions) {
      const Motion motion =
          random_motion(judge, std::exp(std::uniform_real_distribution(-0.7, 1.8)(random)), random);
      const Driven driven = drive(judge, motion);
      if (!driven.within_limits || (variant.forward_only && drives_backward(motion))) continue;
      LegEnds ends{.goal_m = {driven.x_m, driven.y_m},
                   .payload_kg = variant.payload_kg,
                   .cost_at_most_J = 1.05 * driven.energy_J};
      const double line_J = bounds.find(ends, 0.0).cost_J;
      if (!(line_J > 0)) continue;
      ends.start_rad = 0, ends.goal_rad = driven.heading_rad;
      const double bound_J = bounds.find(ends, 0.0).cost_J;
      one.add(driven.energy_J, bound_J);
      raised_percent += 100 * (bound_J / line_J - 1);
    }
    found.below += one.exceptions;
    out << "| " << variant.name << " | " << one.judged << " | " << one.exceptions << " | "
        << text(one.least_percent, 2) << " % | " << text(raised_percent / static_cast<double>(one.judged), 1)
        << " % |\n";
  }
}

void write_poses(std::ostream& out, Findings& found) {
  out << "\n## Distance from the best known paths\n\nThe poses of [ways.md](ways.md), 1 to 10 m apart, with "
         "random headings; best known energy less the bound, relative to that energy. CPU times without the "
         "tables, which legs share.\n\n| floor | poses | below the bound | line alone: median gap | 95 % | "
         "with "
         "headings: median | 95 % | largest | poses within 3 m: median | CPU of a leg, median | 95 % "
         "|\n|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n";
  const std::vector<KnownPose> poses = reference_poses();
  for (const char* floor : {"empty", "depot", "warehouse"}) {
    const ways::World world = ways::make_world(floor);
    const Plant plant = make_plant(world.world.robot);
    LegBounds bounds(plant, world.world.robot, &world.space);
    std::vector<double> line_gaps, gaps, near, times_ms;
    long exceptions = 0;
    for (const KnownPose& pose : poses) {
      if (pose.problem.floor != floor) continue;
      LegEnds ends{.start_m = {pose.problem.start.x_m, pose.problem.start.y_m},
                   .goal_m = pose.problem.goal_m,
                   .way_at_most_m = pose.best_J / 10,
                   .cost_at_most_J = 1.2 * pose.best_J};
      line_gaps.push_back(100 * (1 - bounds.find(ends, 0.0).cost_J / pose.best_J));
      ends.start_rad = pose.problem.start.heading_rad, ends.goal_rad = pose.problem.goal_heading_rad;
      const LegBound bound = bounds.find(ends, 0.0);
      const double begin_ms = cpu_ms();
      [[maybe_unused]] const LegBound again = bounds.find(ends, 0.0);
      times_ms.push_back(cpu_ms() - begin_ms);
      exceptions += bound.cost_J > pose.best_J;
      gaps.push_back(100 * (1 - bound.cost_J / pose.best_J));
      if (pose.problem.reach_m() < 3) near.push_back(gaps.back());
    }
    out << "| " << floor << " | " << gaps.size() << " | " << exceptions;
    for (const double gap : {share(line_gaps, 0.5), share(line_gaps, 0.95), share(gaps, 0.5),
                             share(gaps, 0.95), share(gaps, 1), share(near, 0.5)})
      out << " | " << text(gap, 1) << " %";
    out << " | " << text(share(times_ms, 0.5), 0) << " ms | " << text(share(times_ms, 0.95), 0) << " ms |\n";
    found.below += exceptions;
    found.leg_ms = std::max(found.leg_ms, share(times_ms, 0.5));
    const bool open = floor == std::string("empty");
    double& median_percent = open ? found.open_percent : found.maps_percent;
    median_percent = std::max(median_percent, share(gaps, 0.5));
    if (open) found.open_95_percent = share(gaps, 0.95);
  }
}

/// A pose at a distance along x, and the least energy that two other searches found for it.
struct OtherPose {
  double reach_m, start_deg, goal_deg, best_J;
};
constexpr OtherPose kOtherPoses[] = {
    {1, 0, 90, 46.81},   {2, 0, -135, 73.32},  {3, 0, 180, 96.84},    {4, 0, -60, 100.28},
    {6, 0, 120, 142.87}, {8, 0, -30, 170.42},  {10, 0, 150, 217.80},  {5, 0, -15, 116.87},
    {1, -45, 45, 42.12}, {1.5, 90, 90, 65.42}, {2, 0, 180, 78.17},    {3, -30, -90, 86.50},
    {4, 20, 20, 99.29},  {5, -90, 90, 124.42}, {7, 120, -30, 161.04}, {9.5, -60, 60, 199.32}};

/// Poses whose energies come from other programs.
void write_other_poses(std::ostream& out) {
  out << "\n## Poses of other searches\n\nOpen floor; the energy is the least of a brute-force search and of "
         "a joint program of path and speed, both without this planner.\n\n| distance | headings at start "
         "and goal | least energy known | line alone: gap | with headings: gap "
         "|\n|---:|---:|---:|---:|---:|\n";
  const ways::World world = ways::make_world("empty");
  const Plant plant = make_plant(world.world.robot);
  LegBounds bounds(plant, world.world.robot, nullptr);
  std::vector<double> line_gaps, gaps;
  for (const auto& [reach_m, start_deg, goal_deg, best_J] : kOtherPoses) {
    constexpr double kDegree_rad = std::numbers::pi / 180;
    LegEnds ends{.goal_m = {reach_m, 0}, .cost_at_most_J = 1.2 * best_J};
    line_gaps.push_back(100 * (1 - bounds.find(ends, 0.0).cost_J / best_J));
    ends.start_rad = start_deg * kDegree_rad, ends.goal_rad = goal_deg * kDegree_rad;
    gaps.push_back(100 * (1 - bounds.find(ends, 0.0).cost_J / best_J));
    out << "| " << text(reach_m, 1) << " m | " << text(start_deg, 0) << ", " << text(goal_deg, 0) << " deg | "
        << text(best_J, 2) << " J | " << text(line_gaps.back(), 1) << " % | " << text(gaps.back(), 1)
        << " % |\n";
  }
  out << "| median | | | " << text(share(line_gaps, 0.5), 1) << " % | " << text(share(gaps, 0.5), 1)
      << " % |\n";
}

struct PlannedKind {
  const char* kind;
  unsigned cases;
  const char* what;
  bool in_reverse;
};
constexpr PlannedKind kPlannedKinds[] = {
    {"open", 100, "0.7 to 10 m, every second goal with a heading", false},
    {"corner", 100, "at most 2 m with at least 135 degrees of turning", false},
    {"behind", 40, "1 to 10 m behind, heading kept, in reverse or forward", true},
    {"obstacles", 40, "one leg among racks, doors and boxes", false},
    {"stops", 40, "two legs there, the stop's heading free", false},
    {"docking", 40, "into or out of a slot of 0.8 to 1 m, in reverse or forward", true},
    {"dead_end", 24, "into or out of a dead end without room to turn, in reverse or forward", true}};

/// Plans of drawn missions against their own bounds, as `joulepath plan` states them.
void write_plans(std::ostream& out, Findings& found) {
  out << "\n## Plans and their own bounds\n\nMissions drawn by `benchmarks/ways/joint_cases.hpp`, planned by "
         "the program; its energy less the bound, relative to that energy. Part: what the program names as "
         "the bound's weakest one, in plans.\n\n| kind | missions | plans | below the bound | gap, median | "
         "95 % | largest | part: line | headings | corners | without a bound "
         "|\n|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n";
  const ways::JointFloors floors;
  for (const auto& [kind, cases, what, in_reverse] : kPlannedKinds) {
    std::vector<double> gaps;
    long plans = 0, exceptions = 0;
    std::map<PathBound::Part, long> parts;
    for (unsigned k = 0; k < cases; ++k) {
      const ways::JointCase one = ways::joint_case(floors, kind, 11, k);
      MissionWorld world = one.world->world;
      if (in_reverse) world.robot.limits->reverse_speed_m_s = world.robot.limits->speed_m_s;
      const PlanOptions options{.solver = SolverChoice::fast, .baselines = false, .path_bound = true};
      const Plan plan = plan_mission(one.mission, world, options, &one.world->space);
      if (plan.status > SolveStatus::feasible) continue;
      ++plans;
      if (!plan.path_bound || !plan.path_bound->energy_J) continue;
      exceptions += *plan.path_bound->energy_J > plan.energy.total_J();
      gaps.push_back(100 * (1 - *plan.path_bound->energy_J / plan.energy.total_J()));
      ++parts[plan.path_bound->part];
    }
    out << "| " << what << " | " << cases << " | " << plans << " | " << exceptions;
    for (const double at : {0.5, 0.95, 1.0})
      out << " | " << (gaps.empty() ? "-" : text(share(gaps, at), 1) + " %");
    for (const auto part : {PathBound::Part::line, PathBound::Part::headings, PathBound::Part::corners})
      out << " | " << parts[part];
    out << " | " << plans - std::ssize(gaps) << " |\n";
    found.below += exceptions;
  }
}

PowerForm nomad_form() {
  const Robot robot = read_robot("scenarios/robots/nomad_super_scout.yaml");
  return power_form(make_plant(robot), *robot.limits, 0);
}

void write_tables(std::ostream& out, Findings& found) {
  const PowerForm form = nomad_form();
  out << "\n## Tables\n\nOne for a robot, a payload, a price of time and a length of the line; all lengths "
         "above the greatest share one.\n\n| length of the line | CPU |\n|---:|---:|\n";
  for (const double way_m : {0.5, 1.0, 2.0, long_line_m(form, 0)}) {
    const double begin_ms = cpu_ms();
    const RateTable table = rate_table(form, way_m, 0, true, true);
    const double table_ms = cpu_ms() - begin_ms;
    found.table_ms = std::max(found.table_ms, table_ms);
    out << "| " << text(table.line.length_m(), 1) << " m | " << text(table_ms, 0) << " ms |\n";
  }
}

void write_lines(std::ostream& out, Findings& found) {
  const PowerForm form = nomad_form();
  out << "\n## Straight lines\n\nThe bound drives a straight line; what it loses there it loses "
         "everywhere.\n\n| length | least energy of the line | bound | "
         "difference | CPU |\n|---:|---:|---:|---:|---:|\n";
  const ways::World world = ways::make_world("empty");
  for (const double way_m : {1.0, 2.0, 4.0, 10.0}) {
    const ways::Problem problem{.floor = "empty", .start = {5, 5, 0}, .goal_m = {5 + way_m, 5}};
    const double line_J = ways::planned(world, problem).energy_J, begin_ms = cpu_ms();
    const double bound_J = line_bound(form, way_m, 0.0).energy_J;
    found.line_J = std::max(found.line_J, line_J - bound_J);
    out << "| " << text(way_m, 0) << " m | " << text(line_J, 2) << " J | " << text(bound_J, 2) << " J | "
        << text(line_J - bound_J, 2) << " J | " << text(cpu_ms() - begin_ms, 0) << " ms |\n";
  }
}

}  // namespace
}  // namespace joulepath::path_bound

int main(int count, char** words) {
  using namespace joulepath::path_bound;
  if (count < 4) return 2;
  std::ofstream out(words[1]);
  out << "# A bound over all paths\n\n"
      << words[3]
      << "\n\nWhat it bounds, and the proof: [nlp.md](../../docs/nlp.md). The robot is the Nomad Super "
         "Scout.\n\n";
  Findings found;
  std::ostringstream parts;
  write_motions(parts, std::atoi(words[2]), found);
  write_own_poses(parts, std::atoi(words[2]) / 100, found);
  write_poses(parts, found);
  write_other_poses(parts);
  write_plans(parts, found);
  write_lines(parts, found);
  write_tables(parts, found);
  write_aims(out, found);
  out << parts.str();
  return found.below > 0 ? 1 : 0;
}
