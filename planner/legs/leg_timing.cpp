#include "planner/legs/leg_timing.hpp"

#include <algorithm>
#include <cmath>

#include "planner/profile/profile_solver.hpp"
#include "planner/values/answer_fields.hpp"

namespace joulepath {
namespace {

/// ProfileRequest::proven of a leg whose time is free. Where it is priced, ways are chosen by the energy at
/// that price, which stays proven more closely.
constexpr double kProvenFree = 0.25;

TimeGoal goal_for(double price_W, double given_s) {
  if (std::isinf(price_W)) return {.mode = TimeMode::minimum_time};
  if (price_W == 0.0 && std::isinf(given_s)) return {.mode = TimeMode::free_time};
  constexpr double kRounding = 1e-9;
  const double most_s = price_W <= 0 ? given_s * (1 + kRounding) : kNoLimit;
  return {.mode = TimeMode::time_price, .duration_s = most_s, .price_W = price_W};
}

}  // namespace

ProfileRequest LegTiming::question(ProfileRequest stretch, double price_W, SolverChoice solver) const {
  stretch.time = goal_for(price_W, given_s_);
  if (stretch.time.mode == TimeMode::free_time) stretch.proven = kProvenFree;
  stretch.solver = solver;
  return stretch;
}

const std::vector<ProfileResult>& LegTiming::solve(double price_W, SolverChoice solver) {
  auto [entry, fresh] = solved_.try_emplace({price_W, solver});
  if (fresh)
    for (const ProfileRequest& stretch : stretches_) {
      const ProfileRequest request = question(stretch, price_W, solver);
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
  const bool jerk = std::any_of(stretches_.begin(), stretches_.end(), [](const ProfileRequest& stretch) {
    return std::isfinite(stretch.limits.jerk_m_s3);
  });
  if (jerk && std::isfinite(price_W) && !solved_.contains({price_W, solver}))
    return unproven_duration_s(price_W, solver);
  double sum_s = 0.0;
  for (const ProfileResult& result : solve(price_W, solver))
    if (result.profile) sum_s += result.profile->duration_s();
  return sum_s;
}

double LegTiming::unproven_duration_s(double price_W, SolverChoice solver) {
  auto [entry, fresh] = unproven_s_.try_emplace({price_W, solver}, 0.0);
  if (fresh)
    for (const ProfileRequest& stretch : stretches_) {
      const ProfileRequest request = question(stretch, price_W, solver);
      entry->second += remembered(
          answers_, "driving_time", [&] { return driving_time_s(request).value_or(0.0); }, request);
    }
  return entry->second;
}

double LegTiming::least_s(SolverChoice solver) {
  double sum_s = 0.0;
  for (const ProfileResult& result : solve(kNoLimit, solver))
    if (result.summary.lower_bound_s > 0) sum_s += result.summary.lower_bound_s;  // not a number: no proof
  return sum_s;
}

}  // namespace joulepath
