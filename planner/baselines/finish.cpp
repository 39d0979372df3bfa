#include "planner/baselines/finish.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "model/limit_table.hpp"
#include "planner/motion/limit_check.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/nlp/transcription/grid.hpp"

namespace joulepath {
namespace {

struct Worst {
  double ratio{};
  std::string limit{};
  double s{};
};

/// The limit that a profile was shaped by; null if LocalLimits does not use it.
double* shaping_limit(Limits& limits, std::string_view name) {
  constexpr std::string_view kShapedBy[] = {"speed",    "acceleration",     "deceleration",
                                            "yaw_rate", "yaw_acceleration", "lateral_acceleration"};
  const bool shapes = std::find(std::begin(kShapedBy), std::end(kShapedBy), name) != std::end(kShapedBy);
  return shapes ? &(limits.*limit_named(name)->field) : nullptr;
}

Worst worst_use(const ProfileRequest& request, const PathMotion& motion, const Profile& profile) {
  constexpr int kSamples = 4;
  Worst worst;
  double jump_s = 0;
  if (std::isfinite(request.limits.jerk_m_s3) && !is_turn(request.piece) &&
      acceleration_jumps(profile, jump_s))
    return {kNoLimit, "jerk", jump_s};
  for (std::size_t k = 0; k + 1 < profile.time_s.size(); ++k) {
    const double from_s = profile.time_s[k], length_s = profile.time_s[k + 1] - from_s;
    for (int i = 0; i <= kSamples; ++i) {
      const double share = std::clamp(static_cast<double>(i) / kSamples, 1e-7, 1 - 1e-7);
      const ProfileState state = profile.at_time(from_s + share * length_s);
      for_each_limit_use(motion, request.limits, request.speed_caps, state, profile.jerk[k],
                         [&](std::string_view name, double ratio) {
                           if (ratio > worst.ratio) worst = {ratio, std::string(name), state.s};
                         });
    }
  }
  return worst;
}

}  // namespace

BaselineResult no_baseline(std::string name, std::string reason) {
  return {.name = std::move(name), .feasible = false, .reason = std::move(reason)};
}

BaselineResult finish_baseline(const ProfileRequest& request, std::string name, Profile profile,
                               double duration_s, std::map<std::string, double> parameters) {
  constexpr double kTolerance = 1e-6, kSameTime = 1e-7;  // the replay's tolerance
  const double moving_s = profile.time_s.back();
  BaselineResult result{
      .name = std::move(name), .duration_s = duration_s, .parameters = std::move(parameters)};
  char text[160];
  if (moving_s > duration_s * (1 + kSameTime)) {
    std::snprintf(text, sizeof text, "takes %.4g s, %.3g s too long", moving_s, moving_s - duration_s);
    result.reason = text;
    return result;
  }
  profile.wait_s = std::max(0.0, duration_s - moving_s);
  if (request.end_rate > 0 && profile.wait_s > kSameTime * duration_s) {
    result.reason = "arrives early at speed and cannot wait";
    return result;
  }
  const PathMotion motion = path_motion(request);
  constexpr int kParts = 400;
  profile = profile.divided(nlp::mandatory_nodes(motion, request), motion.length() / kParts);
  for (std::size_t k = 0; k + 1 < profile.time_s.size(); ++k)
    result.motion_energy_J += segment_energy_J(motion, profile, k);
  result.energy_J = result.motion_energy_J + duration_s * request.plant.robot.power.standby_W;
  const Worst worst = worst_use(request, motion, profile);
  result.worst_use = worst.ratio;
  result.worst_limit = worst.limit;
  result.feasible = worst.ratio <= 1 + kTolerance;
  if (std::isinf(worst.ratio) && worst.limit == "jerk") {
    std::snprintf(text, sizeof text, "its acceleration jumps at s = %.4g, which a jerk limit does not allow",
                  worst.s < 1e-9 ? 0.0 : worst.s);
    result.reason = text;
  } else if (!result.feasible) {
    std::snprintf(text, sizeof text, "%s at s = %.4g is %.7g times its limit", worst.limit.c_str(),
                  worst.s < 1e-9 ? 0.0 : worst.s, worst.ratio);
    result.reason = text;
  }
  result.profile = std::move(profile);
  return result;
}

bool better(const BaselineResult& result, const BaselineResult& than) {
  if (result.feasible != than.feasible) return result.feasible;
  return result.feasible ? result.energy_J < than.energy_J : result.worst_use < than.worst_use;
}

BaselineResult with_room(const ProfileRequest& request,
                         const std::function<BaselineResult(const ProfileRequest&)>& make) {
  constexpr int kTries = 6;
  constexpr double kNear = 1.02, kMargin = 1e-6;
  ProfileRequest inner = request;
  BaselineResult result = make(inner);
  for (int i = 0; i < kTries && !result.feasible && result.profile && result.worst_use < kNear; ++i) {
    double* limit = shaping_limit(inner.limits, result.worst_limit);
    if (limit == nullptr) break;
    *limit *= (1 - kMargin) / result.worst_use;
    BaselineResult again = make(inner);
    if (!again.profile) break;
    result = std::move(again);
  }
  return result;
}

BaselineResult best_share(
    const ProfileRequest& request, const std::vector<double>& shares,
    const std::function<BaselineResult(const ProfileRequest& inner, double share)>& make) {
  std::optional<BaselineResult> best;
  for (double share : shares) {
    BaselineResult result =
        with_room(request, [&](const ProfileRequest& inner) { return make(inner, share); });
    if (!best || better(result, *best)) best = std::move(result);
  }
  return std::move(*best);
}

}  // namespace joulepath
