#include "planner/motion/replay.hpp"

#include <algorithm>
#include <array>
#include <boost/numeric/odeint.hpp>
#include <cmath>

#include "model/operating_point.hpp"
#include "model/power.hpp"
#include "planner/motion/driven_pose.hpp"
#include "planner/motion/limit_check.hpp"
#include "planner/motion/path_motion.hpp"

namespace joulepath {
namespace {

namespace odeint = boost::numeric::odeint;

using State = std::array<double, 3>;  // position, rate, energy

double supply_at(const PathMotion& motion, const ProfileState& state) {
  const PathMotion::Place place = motion.laws(state.s, state.time_s);
  const Sided<WheelState<double>> wheels = operating_point(
      motion.plant(), PathMotion::body_motion(place.rates, state.rate, state.acceleration), place.site);
  const PowerSupply& supply = motion.plant().robot.power;
  return supply_power_W(supply, {wheels.left.power_W, wheels.right.power_W}) + supply.standby_W;
}

constexpr int kChecks = 8;             ///< of a segment, equal in time
constexpr std::size_t kPlaces = 4000;  ///< about as many along a path, where its parts are few
constexpr double kLeastStep = 1e-12;   ///< of a segment's duration
constexpr double kEdge = 1e-7;         ///< of a part: its law may change at its ends, so samples are inside

/// Places between which neither curvature nor caps change much: some of every smooth part of the path.
std::vector<double> places_along(const ProfileRequest& request) {
  std::vector<double> ends = piece_breakpoints(request.piece);
  for (const SpeedCap& cap : request.speed_caps)
    for (const double s : {cap.from_m, cap.to_m})
      if (s > 0 && s < ends.back()) ends.push_back(s);
  std::sort(ends.begin(), ends.end());
  const std::size_t parts = std::clamp<std::size_t>(kPlaces / ends.size(), 8, 64);
  std::vector<double> places;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    for (std::size_t k = 0; k <= parts; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(parts);
      places.push_back(ends[i] + (ends[i + 1] - ends[i]) * std::clamp(share, kEdge, 1 - kEdge));
    }
  return places;
}

struct Replayer {
  const ProfileRequest& request;
  PathMotion motion;
  ReplayResult result{};

  void check(const ProfileState& state, double jerk) {
    for_each_limit_use(motion, request.limits, request.speed_caps, state, jerk,
                       [&](std::string_view name, double ratio) {
                         const double excess = std::isnan(ratio) ? kNoLimit : ratio - 1;
                         if (excess <= result.worst_violation) return;
                         result.worst_violation = excess;
                         result.limit = name;
                         result.s = state.s;
                       });
  }

  /// A breach that has no size.
  void mark(const char* limit, double s) {
    result.worst_violation = kNoLimit;
    result.limit = limit;
    result.s = s;
  }

  /// The drive must end where the path ends, at the pose to which its curvature led.
  void check_end(double end_s) {
    constexpr double kSameEnd = 1e-6;
    if (std::isinf(result.worst_violation)) return;  // it says more
    const double length = piece_length(request.piece);
    if (!(std::abs(end_s - length) <= kSameEnd * length) || !leads_to_its_end(request.piece))
      mark("path", end_s);
  }

  /// Integrates one segment, in which the acceleration is a smooth function of time.
  void drive(const Profile& profile, std::size_t k, State& state) {
    const double start_s = profile.time_s[k], duration_s = profile.time_s[k + 1] - start_s;
    if (!(duration_s > 0)) return;
    const auto acceleration = [&](double t) {
      return profile.acceleration[k] + profile.jerk[k] * (t - start_s);
    };
    const auto system = [&](const State& x, State& dx, double t) {
      const double a = acceleration(t);
      dx = {x[1], a, supply_at(motion, {t, x[0], std::max(0.0, x[1]), a})};
    };
    auto stepper = odeint::make_controlled(1e-10, 1e-8, odeint::runge_kutta_dopri5<State>());
    const double least_step_s = kLeastStep * duration_s;
    // A kink of the path that no step resolves: power without bound, which no robot has.
    const auto integrate = [&](double from_s, double to_s) {
      double step_s = to_s - from_s;
      for (double t = from_s; to_s - t > least_step_s;) {
        step_s = std::min(step_s, to_s - t);
        const bool moves = t + step_s > t;
        if (moves && stepper.try_step(system, state, t, step_s) == odeint::success) continue;
        if (moves && step_s > least_step_s) continue;
        mark("yaw_acceleration", state[0]);
        return false;
      }
      return true;
    };
    // At a segment's ends the path's law may change: the state is evaluated inside.
    const double edge = 1e-7 * (profile.s[k + 1] - profile.s[k]);
    const auto inside = [&](double t, double shift) {
      check({t, state[0] + shift, std::max(0.0, state[1]), acceleration(t)}, profile.jerk[k]);
    };
    inside(start_s, edge);
    for (int i = 0; i < kChecks; ++i) {
      const double from_s = start_s + duration_s * i / kChecks,
                   to_s = start_s + duration_s * (i + 1) / kChecks;
      if (!integrate(from_s, to_s)) return;
      inside(to_s, i + 1 == kChecks ? -edge : 0.0);
    }
  }

  /// A profile of few nodes may pass a corner between two checks of a long segment: samples every place
  /// inside of segments that have more places than checks.
  void look_along(const Profile& profile) {
    const std::vector<double> places = places_along(request);
    auto from = places.begin();
    for (std::size_t k = 0; k + 1 < profile.s.size(); ++k) {
      const auto to = std::upper_bound(from, places.end(), profile.s[k + 1]);
      if (to - from > kChecks)
        for (auto s = from; s != to; ++s) check(profile.at_s(*s), profile.jerk[k]);
      from = to;
    }
  }
};

}  // namespace

ReplayResult replay(const ProfileRequest& request, const Profile& profile) {
  Replayer replayer{request, path_motion(request)};
  const double standby_W = request.plant.robot.power.standby_W;
  State state{profile.s.front(), profile.rate.front(), 0.0};
  for (std::size_t k = 0; k + 1 < profile.time_s.size(); ++k) replayer.drive(profile, k, state);
  replayer.look_along(profile);
  ReplayResult& result = replayer.result;
  result.duration_s = profile.duration_s();
  result.energy_J = state[2] + standby_W * profile.wait_s;
  result.motion_energy_J = result.energy_J - standby_W * result.duration_s;
  result.end_s = state[0];
  double jump_s = 0;
  if (std::isfinite(request.limits.jerk_m_s3) && !is_turn(request.piece) &&
      acceleration_jumps(profile, jump_s))
    replayer.mark("jerk", jump_s);
  replayer.check_end(result.end_s);
  const Pose pose = piece_point(request.piece, result.s).pose;
  result.x_m = pose.x_m;
  result.y_m = pose.y_m;
  return result;
}

}  // namespace joulepath
