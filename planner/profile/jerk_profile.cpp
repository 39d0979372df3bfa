#include "planner/profile/jerk_profile.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "planner/motion/motion_energy.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/profile/infeasibility_finder.hpp"
#include "planner/profile/jerk_solver.hpp"
#include "planner/profile/profile_solver.hpp"

namespace joulepath {
namespace {

ProfileRequest without_jerk(const ProfileRequest& request) {
  ProfileRequest free = request;
  free.limits.jerk_m_s3 = kNoLimit;
  return free;
}

bool has_deadline(const ProfileRequest& request) {
  const TimeMode mode = request.time.mode;
  return mode != TimeMode::minimum_time && mode != TimeMode::free_time &&
         std::isfinite(request.time.duration_s);
}

/// Least time (s) found under a jerk limit; nothing where no profile is found.
std::optional<double> least_time_s(ProfileRequest request, double jerk_m_s3) {
  request.limits.jerk_m_s3 = jerk_m_s3;
  request.time = {.mode = TimeMode::minimum_time};
  const ProfileResult fastest = find_profile_with_jerk_limit(request);
  if (!fastest.profile) return std::nullopt;
  return fastest.profile->duration_s();
}

/// Smallest jerk limit, to 2 %, with which a profile makes the time; nothing up to 1e4.
std::optional<double> jerk_that_would_do(const ProfileRequest& request) {
  constexpr double kFirst = 1e-3, kLargest = 1e4, kClose = 1.02, kRough = 20;
  const double available_s = has_deadline(request) ? request.time.duration_s : kNoLimit;
  ProfileRequest trial = request;
  trial.accuracy *= kRough;  // its times are a little too long, never too short
  const auto possible = [&](double jerk_m_s3) {
    const std::optional<double> least_s = least_time_s(trial, jerk_m_s3);
    return least_s && *least_s <= available_s;
  };
  double bad = std::max(0.0, request.limits.jerk_m_s3), good = std::max(4 * bad, kFirst);
  for (; !possible(good); good *= 4) {
    bad = good;
    if (good > kLargest) return std::nullopt;
  }
  while (bad > 0 && good > kClose * bad) {
    const double middle = std::sqrt(bad * good);
    (possible(middle) ? good : bad) = middle;
  }
  return good;
}

/// The verdict for a jerk limit with which no profile was found: the smallest one that works, or the time.
ProfileResult blame_jerk(const ProfileRequest& request, ProfileResult result, std::optional<double> least_s) {
  Infeasibility verdict = explain_request(request, "jerk", result.summary.message);
  verdict.amount = std::abs(request.limits.jerk_m_s3);
  verdict.unit = "m/s^3";
  std::ostringstream text;
  text << result.summary.message;
  if (const std::optional<double> enough = jerk_that_would_do(request)) {
    verdict.amount = *enough - request.limits.jerk_m_s3;
    verdict.relaxation["jerk_m_s3"] = *enough;
    text << "; smallest change that works: jerk_m_s3 = " << *enough;
  }
  if (least_s) {
    const char* key = request.time.mode == TimeMode::fixed_time ? "duration_s" : "deadline_s";
    verdict.relaxation[key] = *least_s;
    text << "; smallest change that works: " << key << " = " << *least_s;
  }
  verdict.message = text.str();
  result.summary.status = SolveStatus::infeasible;
  result.summary.message = verdict.message;
  result.infeasibility = std::move(verdict);
  return result;
}

/// What a profile is worth beside the bound of the problem without the jerk limit.
void judge(ProfileResult& result, const ProfileRequest& request, const ProfileResult& bound) {
  const Profile& profile = *result.profile;
  SolveSummary& summary = result.summary;
  const double duration_s = profile.duration_s();
  double value = duration_s, gap = value - bound.summary.lower_bound_s;
  if (request.time.mode == TimeMode::minimum_time) {
    summary.lower_bound_s = bound.summary.lower_bound_s;
  } else {
    const double price_W = request.time.mode == TimeMode::time_price ? request.time.price_W : 0.0;
    value = energy_by_cause(path_motion(request), profile).total_J();
    gap = value - bound.summary.lower_bound_J + price_W * (duration_s - bound.profile->duration_s());
    summary.lower_bound_J = value - gap;
  }
  summary.gap_percent = 100 * gap / std::max(1e-9, std::abs(value));
  const bool closed = summary.gap_percent <= 100 * request.accuracy;
  summary.status = closed ? SolveStatus::optimal : SolveStatus::feasible;
  summary.local = !closed;
  summary.message = "jerk limit: a local optimum; the bound is that of the problem without it";
}

/// No profile was found: is there none, and why?
ProfileResult explain(const ProfileRequest& request, ProfileResult failed) {
  const std::optional<double> least_s = least_time_s(request, request.limits.jerk_m_s3);
  std::ostringstream text;
  if (!least_s)
    text << "no profile is found within the jerk limit from start to end speed";
  else if (has_deadline(request) && *least_s > request.time.duration_s)
    text << "within the jerk limit the fastest profile found takes " << *least_s << " s, "
         << *least_s - request.time.duration_s << " s too long";
  else
    return failed;
  failed.summary.message = text.str();
  return blame_jerk(request, std::move(failed), least_s);
}

}  // namespace

ProfileResult solve_with_jerk_limit(const ProfileRequest& request) {
  ProfileRequest relaxed = without_jerk(request);
  relaxed.solver = SolverChoice::fast;
  ProfileResult bound = solve_profile(relaxed);
  if (!bound.profile) return bound;
  if (!(request.limits.jerk_m_s3 > 0)) {
    ProfileResult none;
    none.summary.message = "a jerk limit of 0 or less allows no change of acceleration: nothing can start";
    return blame_jerk(request, std::move(none), std::nullopt);
  }
  ProfileResult result = find_profile_with_jerk_limit(request);
  if (request.solver == SolverChoice::fast)
    result.summary.handed_over = "a jerk limit couples more than the rates of neighboring nodes";
  if (!result.profile) return explain(request, std::move(result));
  judge(result, request, bound);
  return result;
}

}  // namespace joulepath
