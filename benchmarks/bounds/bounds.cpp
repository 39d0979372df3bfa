// Plans of random problems with their lower bounds, and finer profiles within smaller limits; bounds.py
// judges them.
//
//   bench_bounds FIRST COUNT FINE_NODES OUT.json
// Design: docs/decisions/0803-judges.md
#include <cmath>
#include <cstdio>
#include <fstream>

#include "benchmarks/problems/campaign.hpp"
#include "benchmarks/support/robots.hpp"
#include "planner/motion/replay.hpp"
#include "planner/profile/profile_solver.hpp"
#include "tests/support/with_room.hpp"

namespace joulepath::problems {
namespace {

constexpr unsigned kSeed = 20261122;
constexpr unsigned kClosedForms = 40;                  ///< one problem in this many has a closed form
constexpr double kRooms[] = {1e-6, 1e-5, 1e-4, 1e-3};  ///< by which the finer profile's limits are smaller
constexpr unsigned kCoarse = 5;                        ///< one in this many is planned on a coarse grid
constexpr std::size_t kCoarseNodes = 60;
constexpr double kStrict = 1e-9;         ///< relative violation that a profile within the limits may have
constexpr std::size_t kJerkNodes = 400;  ///< of finer profiles with a jerk limit

/// A straight line with full recovery of braking energy and no binding limit: its optimum has a closed form.
void make_closed_form(Problem& problem) {
  ProfileRequest& request = problem.request;
  Robot robot = request.plant.robot;
  robot.power.regeneration_efficiency = 1;
  robot.effects.clear();
  for (Motor* motor : {&robot.motor.left, &robot.motor.right})
    motor->max_current_A = motor->max_voltage_V = kNoLimit;
  const double duration_s = 2 * piece_length(request.piece) / request.limits.speed_m_s + 4;
  request.plant = make_plant(robot);
  request.limits = {.speed_m_s = 20};
  request.start_rate = request.end_rate = 0;
  request.time = {TimeMode::fixed_time, duration_s};
  problem.kind = "closed form";
}

Json problem_with_price(const Problem& problem) {
  Json json = problem_json(problem);
  if (problem.request.time.mode == TimeMode::time_price)
    json["time"] = {{"mode", "price"}, {"price_W", problem.request.time.price_W}};
  return json;
}

Json profile_json(const ProfileRequest& request, const Profile& profile) {
  const ReplayResult again = replay(request, profile);
  Json json{{"energy_J", again.energy_J},
            {"duration_s", again.duration_s},
            {"violation", again.worst_violation},
            {"limit", again.limit}};
  if (!std::isfinite(request.limits.jerk_m_s3)) json["solution"] = solution_json(profile);
  return json;
}

Json plan_json(const ProfileRequest& request, const ProfileResult& result) {
  const SolveSummary& summary = result.summary;
  Json json{{"status", solve_status_name(summary.status)},
            {"message", summary.message},
            {"nodes", summary.nodes},
            {"lower_bound_J", summary.lower_bound_J},
            {"lower_bound_s", summary.lower_bound_s},
            {"gap", 0.01 * summary.gap_percent},
            {"local", summary.local},
            {"handed_over", summary.handed_over}};
  if (result.profile) json["profile"] = profile_json(request, *result.profile);
  return json;
}

/// A profile on a finer grid within reduced limits, so that it keeps the original limits.
Json finer_json(const ProfileRequest& request, std::size_t nodes) {
  Json json;
  for (const double room : kRooms) {
    ProfileRequest finer = testing::with_room(request, room);
    finer.nodes = nodes;
    finer.draft = !std::isfinite(request.limits.jerk_m_s3);  // limits are checked afterwards
    const ProfileResult result = solve_profile(finer);
    if (!result.profile) return {{"message", result.summary.message}};
    json = profile_json(request, *result.profile);
    json["room"] = room;
    if (json["violation"].get<double>() <= kStrict) break;
  }
  return json;
}

Json look(const std::vector<Robot>& robots, unsigned index, std::size_t fine_nodes) {
  Json json{{"index", index}};
  std::optional<CampaignProblem> one = campaign_problem(robots, kSeed, index);
  if (!one) return json;
  if (index % kClosedForms == 0) {
    make_closed_form(one->problem);
    one->effect.clear();
  }
  ProfileRequest& request = one->problem.request;
  if (index % kCoarse == 3) request.nodes = kCoarseNodes;
  const bool jerk = std::isfinite(request.limits.jerk_m_s3);
  json["problem"] = problem_with_price(one->problem);
  json["problem"]["robot_values"] = robot_json(request.plant.robot);
  json["effect"] = one->effect;
  json["moving_ends"] = one->moving_ends;
  json["plan"] = plan_json(request, solve_profile(request));
  if (request.time.mode == TimeMode::minimum_time || !json["plan"].contains("profile")) return json;
  json["finer"] = finer_json(request, jerk ? kJerkNodes : fine_nodes);
  if (!jerk) return json;
  ProfileRequest free = request;  // the bound is that of this problem
  free.limits.jerk_m_s3 = kNoLimit;
  json["finer_without_jerk"] = finer_json(free, fine_nodes);
  return json;
}

}  // namespace
}  // namespace joulepath::problems

int main(int argc, char** argv) {
  using namespace joulepath;
  if (argc != 5) return std::fputs("usage: bench_bounds FIRST COUNT FINE_NODES OUT.json\n", stderr), 2;
  const std::vector<Robot> robots = four_robots();
  const auto first = static_cast<unsigned>(std::stoul(argv[1]));
  problems::Json all = problems::Json::array();
  for (unsigned k = 0; k < std::stoul(argv[2]); ++k)
    all.push_back(problems::look(robots, first + k, std::stoul(argv[3])));
  std::ofstream(argv[4]) << all.dump() << "\n";
  return 0;
}
