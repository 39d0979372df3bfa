#include "planner/profile/jerk_profile.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "planner/motion/motion_energy.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/motion/replay.hpp"
#include "planner/profile/fastest_s_curve.hpp"
#include "planner/profile/holding_limit.hpp"
#include "planner/profile/infeasibility_finder.hpp"
#include "planner/profile/jerk_solver.hpp"
#include "planner/profile/profile_solver.hpp"
#include "planner/values/verdict_text.hpp"

namespace joulepath {
namespace {

constexpr double kSameDuration = 1e-9;  ///< relative, of times

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

/// The profile of least time found under a jerk limit; nothing if none is found.
std::optional<Profile> fastest_found(ProfileRequest request, double jerk_m_s3) {
  request.limits.jerk_m_s3 = jerk_m_s3;
  request.time = {.mode = TimeMode::minimum_time};
  request.solver = SolverChoice::fast;
  return find_profile_with_jerk_limit(request).profile;
}

/// "; jerk limits the fastest drive for 40 % of its time, ..."
std::string why_slow(const ProfileRequest& request, const Profile& fastest) {
  HoldingLimits limits;
  limits.add(request, fastest);
  return limits.sentence();
}

/// Smallest jerk limit, to 2 %, for which a profile keeps the time; nothing up to 1e4. kLeast if every limit
/// above 0 works.
std::optional<double> jerk_that_would_do(const ProfileRequest& request) {
  constexpr double kFirst = 1e-3, kLeast = 1e-6, kLargest = 1e4, kClose = 1.02, kRough = 20;
  const double available_s = has_deadline(request) ? request.time.duration_s : kNoLimit;
  ProfileRequest trial = request;
  trial.accuracy *= kRough;  // its times are slightly too long, never too short
  const auto possible = [&](double jerk_m_s3) {
    const std::optional<Profile> fastest = fastest_found(trial, jerk_m_s3);
    return fastest && fastest->duration_s() <= available_s;
  };
  double bad = std::max(0.0, request.limits.jerk_m_s3), good = std::max(4 * bad, kFirst);
  for (; !possible(good); good *= 4) {
    bad = good;
    if (good > kLargest) return std::nullopt;
  }
  while (bad == 0 && good > kLeast) {
    const double less = good / 4;
    (possible(less) ? good : bad) = less;
  }
  if (bad == 0) return kLeast;
  while (good > kClose * bad) {
    const double middle = std::sqrt(bad * good);
    (possible(middle) ? good : bad) = middle;
  }
  return good;
}

/// The verdict for a jerk limit with which no profile was found: the smallest limit that works.
ProfileResult blame_jerk(const ProfileRequest& request, ProfileResult result) {
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
  verdict.message = text.str();
  result.summary.status = SolveStatus::infeasible;
  result.summary.message = verdict.message;
  result.infeasibility = std::move(verdict);
  return result;
}

/// The fastest drive that the largest rate, acceleration and jerk of a stretch from rest to rest allow;
/// nothing if one of them is not limited, or if the stretch begins or ends at speed.
std::optional<Profile> fastest_by_jerk(const ProfileRequest& request) {
  const Limits& limits = request.limits;
  const double acceleration = std::max(limits.acceleration_m_s2, limits.deceleration_m_s2);
  if (request.start_rate > 0 || request.end_rate > 0 || !std::isfinite(acceleration)) return std::nullopt;
  const double speed_m_s = travel_sign(request.piece) < 0
                               ? std::min(limits.speed_m_s, limits.reverse_speed_m_s)
                               : limits.speed_m_s;
  return fastest_s_curve(piece_length(request.piece), speed_m_s, acceleration, limits.jerk_m_s3);
}

/// Compares a profile with the bound of the problem without the jerk limit.
void judge(ProfileResult& result, const ProfileRequest& request, const ProfileResult& bound) {
  const Profile& profile = *result.profile;
  SolveSummary& summary = result.summary;
  const double duration_s = profile.duration_s();
  double value = duration_s, gap = 0;
  if (request.time.mode == TimeMode::minimum_time) {
    const std::optional<Profile> fastest = fastest_by_jerk(request);
    const double by_jerk_s = fastest ? fastest->duration_s() * (1 - kSameDuration) : 0.0;
    summary.lower_bound_s = std::min(duration_s, std::max(bound.summary.lower_bound_s, by_jerk_s));
    gap = duration_s - summary.lower_bound_s;
  } else {
    const double price_W = request.time.mode == TimeMode::time_price ? request.time.price_W : 0.0;
    value = planned_energy_J(path_motion(request), profile);
    gap = value - bound.summary.lower_bound_J + price_W * (duration_s - bound.profile->duration_s());
    summary.lower_bound_J = value - gap;
  }
  summary.gap_percent = 100 * gap / std::max(1e-9, std::abs(value));
  const bool closed = summary.gap_percent <= 100 * request.accuracy;
  summary.status = closed ? SolveStatus::optimal : SolveStatus::feasible;
  summary.local = !closed;
  summary.message = "jerk limit: a local optimum; the bound is that of the problem without it";
}

/// The same request with the jerk limit, to 1e-6, whose fastest drive takes the requested time.
ProfileRequest with_enough_jerk(ProfileRequest request) {
  constexpr double kLargest = 1e6, kClose = 1 + 1e-6;
  double bad = request.limits.jerk_m_s3, good = kLargest;
  while (good > kClose * bad) {
    request.limits.jerk_m_s3 = std::sqrt(bad * good);
    const bool enough = fastest_by_jerk(request)->duration_s() <= request.time.duration_s;
    (enough ? good : bad) = request.limits.jerk_m_s3;
  }
  request.limits.jerk_m_s3 = good;
  return request;
}

/// A verdict of the problem without the jerk limit. It holds with the limit; what it offers is planned with
/// it, too.
ProfileResult also_with_jerk(const ProfileRequest& request, ProfileResult refused, bool by_time) {
  Infeasibility& verdict = *refused.infeasibility;
  const std::optional<double> least_s = by_time ? least_time_found_s(request) : std::nullopt;
  if (!by_time)
    offer_what_plans(request, verdict);
  else if (least_s && *least_s > request.time.duration_s)
    verdict = explain_long(request, *least_s);
  refused.summary.message = verdict.message;
  return refused;
}

/// The verdict for a time before the fastest drive that the jerk limit allows. It offers that drive, and the
/// jerk limit with which it is fast enough, if all other limits are kept.
ProfileResult too_soon(const ProfileRequest& request, const Profile& fastest) {
  const double asked_s = request.time.duration_s, least_s = fastest.duration_s();
  std::ostringstream text;
  text.precision(7);
  text << "within the jerk limit the fastest drive takes at least " << least_s << " s, " << least_s - asked_s
       << " s too long" << why_slow(request, fastest);
  Infeasibility verdict = explain_request(request, "jerk", "");
  verdict.amount = least_s - asked_s;
  verdict.unit = "s";
  if (replay(request, fastest).valid()) {
    const char* key = request.time.mode == TimeMode::fixed_time ? "duration_s" : "deadline_s";
    verdict.relaxation[key] = least_s;
    text << "; smallest change that works: " << key << " = " << least_s;
  }
  const ProfileRequest enough = with_enough_jerk(request);
  const Profile enough_fast = *fastest_by_jerk(enough);
  if (enough_fast.duration_s() <= request.time.duration_s && replay(enough, enough_fast).valid()) {
    verdict.relaxation["jerk_m_s3"] = enough.limits.jerk_m_s3;
    text << (verdict.relaxation.size() > 1 ? ", or jerk_m_s3 = "
                                           : "; smallest change that works: jerk_m_s3 = ")
         << enough.limits.jerk_m_s3;
  }
  verdict.message = text.str();
  ProfileResult result;
  result.summary.status = SolveStatus::infeasible;
  result.summary.message = verdict.message;
  result.infeasibility = std::move(verdict);
  return result;
}

/// The shortest way (m) from start to end speed with the jerk limit and the limit of acceleration: the mean
/// of both speeds for as long as the change takes, without acceleration at both ends.
double least_change_m(const ProfileRequest& request) {
  const double from = request.start_rate, to = request.end_rate, change = std::abs(to - from);
  const double jerk = request.limits.jerk_m_s3;
  const double most = to > from ? request.limits.acceleration_m_s2 : request.limits.deceleration_m_s2;
  const double lasts_s =
      change * jerk <= most * most ? 2 * std::sqrt(change / jerk) : change / most + most / jerk;
  return 0.5 * (from + to) * lasts_s;
}

/// Decides why no profile was found. A deadline that no bound excludes is not refused.
ProfileResult explain(const ProfileRequest& request, ProfileResult failed) {
  const std::optional<Profile> fastest = fastest_found(request, request.limits.jerk_m_s3);
  std::ostringstream text;
  text.precision(7);
  if (!fastest && least_change_m(request) > piece_length(request.piece)) {
    failed.summary.message = "no profile leads from start to end speed within the jerk limit";
    return blame_jerk(request, std::move(failed));
  }
  if (!fastest) {
    failed.summary.status = SolveStatus::failed;
    failed.summary.message = "no profile is found within the jerk limit; whether there is one is not known";
    return failed;
  }
  const double late_s = fastest->duration_s() - request.time.duration_s;
  if (has_deadline(request) && late_s > 0) {
    text << "within the jerk limit the fastest profile found takes " << fastest->duration_s() << " s, "
         << late_s << " s too long; whether there is a faster one is not known"
         << why_slow(request, *fastest);
    failed.summary.message = text.str();
  }
  return failed;
}

/// The closed form as a profile: unchanged for the least time, slowed down to a requested time.
void take_s_curve(const ProfileRequest& request, Profile fastest, ProfileResult& result) {
  const double slower = has_deadline(request) ? request.time.duration_s / fastest.duration_s() : 1.0;
  for (std::size_t k = 0; k < fastest.time_s.size(); ++k) {
    fastest.time_s[k] *= slower;
    fastest.rate[k] /= slower;
  }
  for (double& acceleration : fastest.acceleration) acceleration /= slower * slower;
  for (double& jerk : fastest.jerk) jerk /= slower * slower * slower;
  if (!replay(request, fastest).valid()) return;
  result.summary.solver = "s_curve";
  result.summary.nodes = fastest.s.size();
  result.profile = std::move(fastest);
}

}  // namespace

ProfileResult solve_with_jerk_limit(const ProfileRequest& request) {
  ProfileRequest relaxed = without_jerk(request);
  relaxed.solver = SolverChoice::fast;
  ProfileResult bound = solve_profile(relaxed);
  const std::optional<Profile> fastest =
      request.limits.jerk_m_s3 > 0 ? fastest_by_jerk(request) : std::nullopt;
  const bool soon = fastest && has_deadline(request) &&
                    request.time.duration_s < fastest->duration_s() * (1 - kSameDuration);
  if (!bound.profile) {
    // A relaxation of the problem without the jerk limit does not apply to the one with it.
    const bool by_time = has_deadline(request) && bound.infeasibility && is_late(*bound.infeasibility);
    if (by_time && soon) return too_soon(request, *fastest);
    return bound.infeasibility ? also_with_jerk(request, std::move(bound), by_time) : bound;
  }
  if (!(request.limits.jerk_m_s3 > 0)) {
    ProfileResult none;
    none.summary.message =
        "a jerk limit of 0 or less allows no change of acceleration: the robot cannot start";
    return blame_jerk(request, std::move(none));
  }
  if (soon) return too_soon(request, *fastest);
  const bool exact =
      fastest && request.time.mode == TimeMode::minimum_time && replay(request, *fastest).valid();
  ProfileResult result;
  if (!exact) result = find_profile_with_jerk_limit(request);
  if (!result.profile && fastest) take_s_curve(request, *fastest, result);
  if (!result.profile) return explain(request, std::move(result));
  judge(result, request, bound);
  return result;
}

}  // namespace joulepath
