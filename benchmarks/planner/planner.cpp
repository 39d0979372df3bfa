// Speed and accuracy of the profile optimizer on seeded random problems. CPU time of this process: other load
// on the machine has little influence.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "benchmarks/support/cpu_time.hpp"
#include "benchmarks/support/prepared_problem.hpp"
#include "planner/motion/replay.hpp"
#include "planner/nlp/fast/fast_solver.hpp"
#include "planner/nlp/ipopt/ipopt_solver.hpp"
#include "planner/profile/front.hpp"
#include "planner/profile/profile_solver.hpp"
#include "tests/support/random_profiles.hpp"

namespace joulepath {
namespace {

/// Figures of one kind, and their order statistics.
struct Sample {
  std::vector<double> values{};
  void add(double value) { values.push_back(value); }
  double share(double q) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
  }
};

std::string format(const char* pattern, auto... values) {
  char text[400];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

constexpr unsigned kSeed = 20240501;

/// A random problem with its time goal: T = 1.05 to 2 T_min as a budget, or free (one in four).
struct RandomProblem {
  ProfileRequest request;
  bool valid{};
};

RandomProblem next_problem(testing::RandomProfiles& random, int index) {
  RandomProblem problem{random.next(testing::kPathClasses[index % 4])};
  problem.request.solver = SolverChoice::fast;
  const double factor = random.uniform(1.05, 2);
  const bool free = random.choice(4) == 0;
  problem.request.time = {TimeMode::minimum_time};
  const ProfileResult fastest = solve_profile(problem.request);
  problem.valid = fastest.profile && replay(problem.request, *fastest.profile).valid();
  if (!problem.valid) return problem;
  problem.request.time = free ? TimeGoal{TimeMode::free_time}
                              : TimeGoal{TimeMode::time_budget, factor * fastest.profile->duration_s()};
  return problem;
}

struct Campaign {
  int problems{}, valid{}, optimal{}, local{}, handed_over{};
  Sample whole_ms{}, gap{};
  std::vector<ProfileRequest> kept{};  ///< some of each class, for the other sections
  std::vector<double> kept_energy_J{};
  std::vector<std::string> failures{};
};

Campaign run_campaign(int count) {
  Campaign campaign{.problems = count};
  testing::RandomProfiles random(kSeed);
  for (int i = 0; i < count; ++i) {
    const RandomProblem problem = next_problem(random, i);
    const double start = cpu_ms();
    const ProfileResult result = solve_profile(problem.request);
    campaign.whole_ms.add(cpu_ms() - start);
    const ReplayResult again = result.profile ? replay(problem.request, *result.profile) : ReplayResult{};
    const bool good = problem.valid && result.profile && again.valid();
    campaign.valid += good;
    if (!good)
      campaign.failures.push_back(format("problem %d (%s): %s %s %.2g", i, testing::kPathClassNames[i % 4],
                                         result.summary.message.c_str(), again.limit.c_str(),
                                         again.worst_violation));
    if (!good) continue;
    campaign.optimal += result.summary.status == SolveStatus::optimal;
    campaign.local += result.summary.local;
    campaign.handed_over += !result.summary.handed_over.empty();
    campaign.gap.add(result.summary.gap_percent);
    if (campaign.kept.size() >= 200) continue;
    campaign.kept.push_back(problem.request);
    campaign.kept_energy_J.push_back(again.energy_J);
    if (i % 100 == 0) std::fprintf(stderr, "%d\n", i);
  }
  return campaign;
}

std::string campaign_section(Campaign& c) {
  std::string text = format(
      "| solved, replay within every limit (1e-6) | %d of %d | 100 %% |\n"
      "| of these: optimal by its bound (gap <= 0.01 %%), local, handed over to Ipopt | %d, %d, %d | |\n"
      "| certified optimality gap: median, p95, max | %.5f, %.4f, %.3g %% | |\n"
      "| whole solve (grid, refinement, limits between nodes, bound), fast solver: median, p95 | %.1f, "
      "%.1f ms | |\n",
      c.valid, c.problems, c.optimal, c.local, c.handed_over, c.gap.share(0.5), c.gap.share(0.95),
      c.gap.share(1), c.whole_ms.share(0.5), c.whole_ms.share(0.95));
  return text;
}

std::string accuracy_section(const Campaign& campaign) {
  Sample ratio;
  const std::size_t count = std::min<std::size_t>(campaign.kept.size(), 100);
  for (std::size_t i = 0; i < count; ++i) {
    ProfileRequest fine = campaign.kept[i];
    fine.nodes = 4000;
    const ProfileResult result = solve_profile(fine);
    if (!result.profile) continue;
    ratio.add(campaign.kept_energy_J[i] / replay(fine, *result.profile).energy_J);
  }
  return format(
      "| replayed energy at N = 200 / at N = 4,000 (%zu problems): median, p95, max | %.6f, %.5f, %.5f | "
      "1.00001, 1.0005, 1.0015 |\n",
      ratio.values.size(), ratio.share(0.5), ratio.share(0.95), ratio.share(1));
}

std::string closed_form_section() {
  Robot robot = testing::nomad();
  robot.inertia.wheel_axle_inertia_kg_m2 = 0.148 - 23.98 * 0.01 / 2;
  robot.power = {.standby_W = 0.0, .regeneration_efficiency = 1.0};
  ProfileRequest request{
      .piece = straight_piece({}, 10.0), .plant = make_plant(robot), .limits = *robot.limits};
  request.time = {TimeMode::fixed_time, 17.3694};
  const ProfileResult result = solve_profile(request);
  const double energy_J = result.profile ? replay(request, *result.profile).energy_J : 0.0;
  return format(
      "| straight line against the closed form, 79.5060763 J (N = 200) | %.7f J, relative %.1e | 1e-6 |\n",
      energy_J, energy_J / 79.5060763 - 1);
}

std::string ipopt_section(const Campaign& campaign) {
  Sample ms, iterations;
  int agreeing = 0, count = 0;
  for (std::size_t i = 0; i < campaign.kept.size() && count < 60; ++i, ++count) {
    const PreparedProblem prepared(campaign.kept[i], 200);
    const double start = cpu_ms();
    const nlp::Solution reference = nlp::solve_with_ipopt(prepared.problem, prepared.guess);
    ms.add(cpu_ms() - start);
    iterations.add(reference.iterations);
    const nlp::Solution fast = nlp::solve_fast(prepared.problem, prepared.guess);
    agreeing += std::abs(fast.objective - reference.objective) <= 1e-6 * std::abs(reference.objective);
  }
  return format(
      "| Ipopt at N = 200 (%d problems): median, p95; iterations | %.0f, %.0f ms; %.0f | 50 ms, 80 ms |\n"
      "| both solvers' optimum equal to 1e-6 | %d of %d | all |\n",
      count, ms.share(0.5), ms.share(0.95), iterations.share(0.5), agreeing, count);
}

std::string fast_section(const Campaign& campaign) {
  std::string text;
  for (const std::size_t nodes : {50, 100, 200, 400, 800, 1600, 3200, 6400, 12800}) {
    Sample ms, iterations;
    int converged = 0;
    const std::size_t count = std::min<std::size_t>(campaign.kept.size(), nodes <= 400    ? 200
                                                                          : nodes <= 3200 ? 40
                                                                                          : 16);
    for (std::size_t i = 0; i < count; ++i) {
      const PreparedProblem prepared(campaign.kept[i], nodes);
      const double start = cpu_ms();
      const nlp::Solution solution = nlp::solve_fast(prepared.problem, prepared.guess);
      ms.add(cpu_ms() - start);
      iterations.add(solution.iterations);
      converged += solution.converged;
    }
    text += format(
        "| fast solver at N = %zu (%d of %zu converged): median, p95; iterations | %.2f, %.2f ms; %.0f | %s "
        "|\n",
        nodes, converged, count, ms.share(0.5), ms.share(0.95), iterations.share(0.5),
        nodes == 200  ? "0.6 ms, 1 ms"
        : nodes > 200 ? "linear"
                      : "");
  }
  return text;
}

std::string front_section(const Campaign& campaign) {
  Sample ms;
  for (std::size_t i = 0; i < std::min<std::size_t>(campaign.kept.size(), 40); ++i) {
    const double start = cpu_ms();
    const Front front = energy_time_front({{campaign.kept[i]}}, 50);
    if (front.points.size() == 50) ms.add(cpu_ms() - start);
  }
  return format(
      "| front of 50 points at N = 200, transcription included (%zu problems): median, p95 | %.0f, %.0f ms | "
      "30 ms |\n",
      ms.values.size(), ms.share(0.5), ms.share(0.95));
}

int run(const char* file, int count, const char* provenance) {
  Campaign campaign = run_campaign(count);
  std::string text =
      std::string("# The profile optimizer, measured\n\n") + provenance +
      format(" Seed %u; CPU time of the process.\n\n", kSeed) +
      "Random problems: straight lines, Bezier curves, corners of 0.4 to 1.5 m, corners tighter than half "
      "the track (the "
      "inner wheel reverses); payload 0 to 10.5 kg; regeneration 0, 0.6 or 1, per wheel or at the bus; "
      "standby 2, 10 or "
      "20 W; T at most 1.05 to 2 T_min, or free.\n\n| figure | measured | aim |\n|---|---|---|\n";
  text += campaign_section(campaign);
  text += accuracy_section(campaign);
  text += closed_form_section();
  text += ipopt_section(campaign);
  text += fast_section(campaign);
  text += front_section(campaign);
  if (!campaign.failures.empty()) {
    text += "\nNot solved:\n\n";
    for (const std::string& failure : campaign.failures) text += "- " + failure + "\n";
  }
  text +=
      "\nInfeasible and degenerate inputs: tests/planner/nlp/hopeless_requests.cpp has them, each with the "
      "constraint that "
      "has to be named; dynamic programming and closed forms: tests/planner/nlp/optimality_test.cpp.\n";
  std::ofstream(file) << text;
  std::fputs(text.c_str(), stdout);
  return 0;
}

}  // namespace
}  // namespace joulepath

int main(int argc, char** argv) {
  if (argc != 4) return std::fputs("usage: bench_planner FILE PROBLEMS PROVENANCE\n", stderr), 2;
  return joulepath::run(argv[1], std::atoi(argv[2]), argv[3]);
}
