#include "planner/legs/leg_timing.hpp"

#include <cmath>

#include "planner/profile/profile_solver.hpp"
#include "planner/values/answer_fields.hpp"

namespace joulepath {
namespace {

TimeGoal goal_for(double price_W, double given_s) {
  if (std::isinf(price_W)) return {.mode = TimeMode::minimum_time};
  if (price_W == 0.0 && std::isinf(given_s)) return {.mode = TimeMode::free_time};
  constexpr double kRounding = 1e-9;
  const double most_s = price_W <= 0 ? given_s * (1 + kRounding) : kNoLimit;
  return {.mode = TimeMode::time_price, .duration_s = most_s, .price_W = price_W};
}

}  // namespace

const std::vector<ProfileResult>& LegTiming::solve(double price_W, SolverChoice solver) {
  auto [entry, fresh] = solved_.try_emplace({price_W, solver});
  if (fresh)
    for (ProfileRequest request : stretches_) {
      request.time = goal_for(price_W, given_s_);
      request.solver = solver;
      entry->second.push_back(remembered(
          answers_, "profile", [&] { return solve_profile(request); }, request));
    }
  return entry->second;
}

void LegTiming::solve_roughly(bool roughly) {
  for (ProfileRequest& request : stretches_) request.draft = roughly;
  forget();
}

double LegTiming::duration_s(double price_W, SolverChoice solver) {
  double sum_s = 0.0;
  for (const ProfileResult& result : solve(price_W, solver))
    if (result.profile) sum_s += result.profile->duration_s();
  return sum_s;
}

double LegTiming::least_s(SolverChoice solver) {
  double sum_s = 0.0;
  for (const ProfileResult& result : solve(kNoLimit, solver))
    if (result.summary.lower_bound_s > 0) sum_s += result.summary.lower_bound_s;  // not a number: no proof
  return sum_s;
}

}  // namespace joulepath
