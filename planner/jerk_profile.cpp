#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>

#include "planner/infeasibility_finder.hpp"
#include "planner/jerk_filter.hpp"
#include "planner/limit_check.hpp"
#include "planner/nlp/grid.hpp"

namespace joulepath {
namespace {

constexpr int kRounds = 12;
constexpr double kTolerated = 3e-7;

ProfileRequest without_jerk(const ProfileRequest& request) {
  ProfileRequest free = request;
  free.limits.jerk_m_s3 = kNoLimit;
  return free;
}

/// Largest use of every limit over a profile.
std::map<std::string, double> limit_uses(const ProfileRequest& request, const PathMotion& motion,
                                         const Profile& profile) {
  constexpr int kLooks = 4;
  std::map<std::string, double> uses;
  for (std::size_t k = 0; k + 1 < profile.time_s.size(); ++k)
    for (int i = 0; i <= kLooks; ++i) {
      const double share = std::clamp(static_cast<double>(i) / kLooks, 1e-7, 1 - 1e-7);
      const double t = profile.time_s[k] + share * (profile.time_s[k + 1] - profile.time_s[k]);
      for_each_limit_use(motion, request.limits, request.speed_caps, profile.at_time(t), profile.jerk[k],
                         [&](std::string_view name, double ratio) {
                           double& most = uses[std::string(name)];
                           most = std::max(most, ratio);
                         });
    }
  return uses;
}

void take_back(ProfileRequest& request, const std::string& limit, double factor) {
  const std::map<std::string, double Limits::*> members{
      {"speed", &Limits::speed_m_s},
      {"acceleration", &Limits::acceleration_m_s2},
      {"deceleration", &Limits::deceleration_m_s2},
      {"lateral_acceleration", &Limits::lateral_acceleration_m_s2},
      {"yaw_rate", &Limits::yaw_rate_rad_s},
      {"yaw_acceleration", &Limits::yaw_acceleration_rad_s2},
      {"wheel_acceleration", &Limits::wheel_acceleration_rad_s2},
      {"traction", &Limits::traction_coefficient},
      {"motor_power", &Limits::motor_power_W},
      {"battery_power", &Limits::battery_power_W}};
  const auto member = members.find(limit);
  if (member != members.end()) request.limits.*(member->second) *= factor;
  for (Motor* motor : {&request.plant.robot.motor.left, &request.plant.robot.motor.right}) {
    if (limit == "motor_current") motor->max_current_A *= factor;
    if (limit == "motor_voltage") motor->max_voltage_V *= factor;
  }
}

/// Takes back what is exceeded; false when nothing was.
bool take_back_exceeded(ProfileRequest& inner, const std::map<std::string, double>& uses) {
  bool exceeded = false;
  for (const auto& [limit, ratio] : uses) {
    if (ratio <= 1 + kTolerated) continue;
    exceeded = true;
    if (limit != "jerk") take_back(inner, limit, (1 - 1e-6) / ratio);
  }
  return exceeded;
}

void judge(ProfileResult& result, const ProfileRequest& request, const ProfileResult& bound) {
  const Profile& profile = *result.profile;
  SolveSummary& summary = result.summary;
  const double duration_s = profile.duration_s();
  double value = energy_by_cause(path_motion(request), profile).total_J();
  if (request.time.mode == TimeMode::time_price) value += request.time.price_W * duration_s;
  if (request.time.mode == TimeMode::minimum_time) value = duration_s;
  summary.status = SolveStatus::feasible;
  summary.lower_bound_J = std::min(bound.summary.lower_bound_J, value);
  summary.gap_percent = 100 * (value - summary.lower_bound_J) / std::max(1e-9, std::abs(value));
  summary.local = bound.summary.local;
  summary.message = "jerk limit kept by averaging the optimum without it over time";
}

ProfileResult failed(std::string message) {
  ProfileResult result;
  result.summary.message = std::move(message);
  return result;
}

/// The optimum without the jerk limit, its acceleration averaged over time.
ProfileResult average_to_jerk_limit(const ProfileRequest& request) {
  if (request.start_rate > 0 || request.end_rate > 0)
    return failed("a jerk limit is supported from rest to rest only");
  const ProfileResult bound = solve_profile(without_jerk(request));
  if (!bound.profile) return bound;
  double up = 0, down = 0;
  for (double a : bound.profile->acceleration) up = std::max(up, a), down = std::max(down, -a);
  const PathMotion motion = path_motion(request);
  const std::vector<double> borders = nlp::mandatory_nodes(motion, request);
  const bool timed = request.time.mode != TimeMode::minimum_time && request.time.mode != TimeMode::free_time;
  double window_s = std::max(up, down) / request.limits.jerk_m_s3 * (1 + 1e-6);
  ProfileRequest inner = without_jerk(request);
  for (int round = 0; round < kRounds; ++round) {
    if (timed) inner.time.duration_s = request.time.duration_s - window_s;
    inner.speed_caps = request.speed_caps;
    for (SpeedCap& cap : inner.speed_caps) {
      const double reach_m = std::min(1.0, request.limits.speed_m_s) * window_s;
      cap.from_m -= reach_m;
      cap.to_m += reach_m;
    }
    ProfileResult result = solve_profile(inner);
    if (!result.profile)
      return failed("no profile with averaged acceleration makes the time: " + result.summary.message);
    result.profile = averaged_over(*result.profile, window_s).divided(borders, motion.length());
    const std::map<std::string, double> uses = limit_uses(request, motion, *result.profile);
    if (!take_back_exceeded(inner, uses)) {
      judge(result, request, bound);
      return result;
    }
    const auto jerk = uses.find("jerk");
    if (jerk != uses.end() && jerk->second > 1 + kTolerated) window_s *= jerk->second * (1 + 1e-6);
  }
  return failed("limits do not settle under the jerk limit");
}

/// Smallest jerk limit found, to 1 %, with which the averaged profile makes the time; nothing up to 1e4.
std::optional<double> jerk_that_would_do(const ProfileRequest& request) {
  constexpr double kFirst = 1e-3, kLargest = 1e4;
  ProfileRequest trial = request;
  const auto possible = [&](double jerk_m_s3) {
    trial.limits.jerk_m_s3 = jerk_m_s3;
    return average_to_jerk_limit(trial).profile.has_value();
  };
  double bad = std::max(0.0, request.limits.jerk_m_s3), good = std::max(4 * bad, kFirst);
  for (; !possible(good); good *= 4) {
    bad = good;
    if (good > kLargest) return std::nullopt;
  }
  while (bad > 0 && good > 1.01 * bad) {
    const double middle = std::sqrt(bad * good);
    (possible(middle) ? good : bad) = middle;
  }
  return good;
}

/// The verdict for a jerk limit with which no profile was found.
void blame_jerk(const ProfileRequest& request, ProfileResult& result) {
  Infeasibility verdict = explain_request(request, "jerk", result.summary.message);
  verdict.amount = std::abs(request.limits.jerk_m_s3);
  verdict.unit = "m/s^3";
  if (const std::optional<double> enough = jerk_that_would_do(request)) {
    verdict.amount = *enough - request.limits.jerk_m_s3;
    verdict.relaxation["jerk_m_s3"] = *enough;
    std::ostringstream text;
    text << result.summary.message << "; jerk_m_s3 " << *enough << " would do";
    verdict.message = text.str();
  }
  result.summary.message = verdict.message;
  result.infeasibility = std::move(verdict);
}

}  // namespace

ProfileResult solve_with_jerk_limit(const ProfileRequest& request) {
  if (!(request.limits.jerk_m_s3 > 0)) {
    ProfileRequest free = without_jerk(request);
    ProfileResult unlimited = solve_profile(free);
    if (!unlimited.profile) return unlimited;
    ProfileResult result =
        failed("a jerk limit of 0 or less allows no change of acceleration: nothing can start");
    result.summary.status = SolveStatus::infeasible;
    blame_jerk(request, result);
    return result;
  }
  ProfileResult result = average_to_jerk_limit(request);
  const bool from_rest = request.start_rate == 0 && request.end_rate == 0;
  if (!result.profile && !result.infeasibility && from_rest) blame_jerk(request, result);
  return result;
}

}  // namespace joulepath
