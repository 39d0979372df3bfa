// Random problems that the fast solver hands over to Ipopt, or that are not solved at all.
//
//   bench_hand_overs FIRST COUNT     a line per such problem, then the counts, as CSV
#include <cmath>
#include <cstdio>
#include <string>

#include "benchmarks/problems/campaign.hpp"
#include "benchmarks/support/cpu_time.hpp"
#include "benchmarks/support/robots.hpp"
#include "planner/profile/profile_solver.hpp"

namespace joulepath::problems {
namespace {

constexpr unsigned kSeed = 20261123;

int run(unsigned first, unsigned count) {
  const std::vector<Robot> robots = four_robots();
  unsigned none = 0, handed_over = 0, unsolved = 0;
  const double start_ms = cpu_ms();
  for (unsigned index = first; index < first + count; ++index) {
    const std::optional<CampaignProblem> one = campaign_problem(robots, kSeed, index);
    none += !one;
    if (!one) continue;
    const ProfileRequest& request = one->problem.request;
    const ProfileResult result = solve_profile(request);
    const std::string& why = result.summary.handed_over;
    handed_over += !why.empty();
    unsolved += !result.profile;
    if (why.empty() && result.profile) continue;
    std::printf("problem,%u,%s,%s,%s,jerk %g,mode %d,%s,%s,%s\n", index, one->problem.robot_name.c_str(),
                one->problem.kind.c_str(), one->effect.c_str(), request.limits.jerk_m_s3,
                static_cast<int>(request.time.mode), why.empty() ? "no hand-over" : why.c_str(),
                solve_status_name(result.summary.status), result.summary.message.c_str());
    std::fflush(stdout);
  }
  std::printf("sum,%u,%u,%u,%u,%u,%.0f\n", first, count, none, handed_over, unsolved, cpu_ms() - start_ms);
  return 0;
}

}  // namespace
}  // namespace joulepath::problems

int main(int argc, char** argv) {
  if (argc != 3) return std::fputs("usage: bench_hand_overs FIRST COUNT\n", stderr), 2;
  return joulepath::problems::run(static_cast<unsigned>(std::stoul(argv[1])),
                                  static_cast<unsigned>(std::stoul(argv[2])));
}
