// The saving of each planning step on random missions, and the cost of planning.
// usage: bench_missions COUNT SEED HEADER
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <vector>

#include "benchmarks/missions/speeds.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "tests/support/locations.hpp"

namespace {

using namespace joulepath;
using namespace joulepath::bench;

void print_spread(std::vector<double> values, int digits) {
  std::sort(values.begin(), values.end());
  const double middle = 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
  std::printf("%.*f (%.*f to %.*f)", digits, middle, digits, values.front(), digits, values.back());
}

void print_step(const std::vector<Case>& cases, const char* says, const char* before, const char* after) {
  std::printf("| %s |", says);
  for (double Joules::*part : {&Joules::with_standby, &Joules::motion}) {
    std::vector<double> saved_J, percent;
    for (const Case& one : cases) {
      const double from = one.joules.at(before).*part, to = one.joules.at(after).*part;
      saved_J.push_back(from - to);
      percent.push_back(100 * (from - to) / from);
    }
    std::printf(" ");
    print_spread(saved_J, 0);
    std::printf(" | ");
    print_spread(percent, 2);
    std::printf(" |");
  }
  std::printf("\n");
}

void print_savings(const std::vector<Case>& cases) {
  std::printf("| step | saved J | saved %% | of motion alone J | %% |\n|---|---|---|---|---|\n");
  print_step(cases, "speed profile, against a trapezoid at maximum acceleration", "plain", "profile");
  print_step(cases, "time at one price of a second, against a split by length", "profile", "time");
  print_step(cases, "turn or arc, at corners and stops", "time", "arcs");
  print_step(cases, "path by energy, still with stop, turn, go", "time", "routes");
  print_step(cases, "control points moved, after turn or arc", "arcs", "refinement");
  print_step(cases, "order of stops", "time", "order");
  print_step(cases, "**all together, against the plain plan**", "plain", "together");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  const int count = std::atoi(argv[1]);
  std::mt19937 random(static_cast<unsigned>(std::atoi(argv[2])));
  const Robot robot = read_robot(JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml");
  const std::vector<Floor> all = floors(robot);
  std::vector<Case> cases;
  int draws = 0;
  for (; static_cast<int>(cases.size()) < count && draws < 10 * count; ++draws) {
    if (auto one = random_case(all[cases.size() % all.size()], random)) cases.push_back(std::move(*one));
    std::fprintf(stderr, "\r%zu of %d missions", cases.size(), count);
  }
  std::fprintf(stderr, "\n");
  std::printf("# Missions: what each step saves\n\n%s\n\n", argv[3]);
  std::printf("%zu random missions, in turn over", cases.size());
  for (const Floor& floor : all) std::printf("%s %s", &floor == &all.front() ? "" : ",", floor.name.c_str());
  std::printf(
      " (60 x 40 m): three picks of 1 to 4 kg and a drop where the robot began, 5 s of dwell at each pick, "
      "the "
      "Nomad's robot file (standby 10 W assumed, no regeneration). %d draws were refused (a trapezoid that "
      "exceeds a limit, a "
      "plan that cannot be driven) and replaced.\n\n"
      "The plain plan drives the shortest route with stop, turn, go, a trapezoid at maximum "
      "acceleration, time split over "
      "the legs by length, stops in the order drawn. All plans of a mission take the same total time, that "
      "of the plain plan: "
      "standby is the same for each and left out of the choices. Steps are taken alone, all but the first "
      "with energy-optimal profiles: "
      "the time split on "
      "the plain mission, the others on the plain mission with its time split, control points after turn or "
      "arc. Figures are "
      "median (least to most).\n\n",
      draws - static_cast<int>(cases.size()));
  print_savings(cases);
  std::printf("\nThe order drawn was not the best in %d of %zu missions.\n\n## A simple fleet model\n\n",
              static_cast<int>(
                  std::count_if(cases.begin(), cases.end(), [](const Case& c) { return c.order_changed; })),
              cases.size());
  std::printf(
      "Mass x |acceleration| x speed + rolling force x speed in Euler steps of half a second, on the same "
      "trajectories, the rolling force "
      "being the robot file's own friction. It has no copper loss and no turning in place, and counts "
      "braking as accelerating. Its error: ");
  const auto spread_of = [&](double Case::*figure, int digits) {
    std::vector<double> values;
    for (const Case& one : cases) values.push_back(one.*figure);
    print_spread(values, digits);
  };
  spread_of(&Case::fleet_motion_percent, 1);
  std::printf(" %% of the motion's energy, ");
  spread_of(&Case::fleet_percent, 1);
  std::printf(
      " %% of the energy with standby.\n\n## Speed\n\nCPU time of one thread, floors prepared before, fast "
      "solver.\n\n- A mission of the table, four legs under a deadline: ");
  spread_of(&Case::together_cpu_s, 2);
  std::vector<double> ten_s;
  for (int k = 0; k < 5; ++k) ten_s.push_back(ten_legs_s(all.back(), random));
  std::printf(" s.\n- Ten legs on the generated warehouse, routes searched anew: ");
  print_spread(ten_s, 2);
  const double given_s = given_paths_s(robot, random);
  std::printf(" s.\n- A mission of two given curves: %.1f ms, which is %.0f a minute on two cores.\n",
              1e3 * given_s, 120 / given_s);
}
