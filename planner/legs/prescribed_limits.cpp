#include "planner/legs/prescribed_limits.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "model/limit_table.hpp"
#include "planner/legs/leg_motion.hpp"
#include "planner/legs/stretch.hpp"
#include "planner/values/verdict_text.hpp"

namespace joulepath {
namespace {

constexpr double kTolerance = 1e-6;  ///< relative, as in the replay

/// The place where a motion exceeds a limit most.
struct Excess {
  const Limit* row{};
  double value{};
  double limit{};
  double time_s{};
  SampledState state{};
  double jump_m_s2{};  ///< of the acceleration, where the value is a jerk without bound

  double amount() const { return std::abs(value) - limit; }
};

/// Finds the places where a prescribed leg exceeds limits: those of the table, speed zones, speed mask.
struct LimitSearch {
  const LegPlan& planned;
  std::size_t leg{};
  const MissionRequest& mission;
  const MissionWorld& world;
  const Plant& plant;

  /// For each exceeded limit, the place of the largest excess.
  std::vector<Excess> worst() const {
    const Limits limits = limits_along(world.robot, mission.legs[leg].payload);
    std::vector<Excess> excesses;
    const Trajectory& motion = *planned.prescribed;
    if (motion.size() == 0) return excesses;
    const SampledMotion driven = prescribed_motion(planned, plant);
    for (std::size_t k = 0; k + 1 < motion.size(); ++k)
      for (const double share : {1e-6, 0.5, 1 - 1e-6}) {
        const double time_s = motion.time_s[k] + share * (motion.time_s[k + 1] - motion.time_s[k]);
        sample(driven, sampled_state(motion, time_s), time_s, limits, excesses);
      }
    if (limits.jerk_m_s3 < kNoLimit) look_for_jumps(limits.jerk_m_s3, excesses);
    return excesses;
  }

 private:
  static void add(std::vector<Excess>& excesses, const Excess& one) {
    if (!(limit_fraction(one.value, one.limit) > 1 + kTolerance)) return;
    const auto same = std::find_if(excesses.begin(), excesses.end(),
                                   [&](const Excess& other) { return other.row == one.row; });
    if (same == excesses.end())
      excesses.push_back(one);
    else if (one.amount() > same->amount())
      *same = one;
  }

  void sample(const SampledMotion& driven, const SampledState& state, double time_s, const Limits& limits,
              std::vector<Excess>& excesses) const {
    const BodyMotion<double>& body = state.motion;
    const double gain_m_s2 = body.acceleration_m_s2 * (body.speed_m_s < 0 ? -1.0 : 1.0);
    for_each_limit(limit_state(plant, body, driven.at(time_s).site, gain_m_s2, 0.0), limits,
                   [&](const Limit& row, double value, double limit) {
                     add(excesses, {&row, value, limit, time_s, state});
                   });
    const double cap_m_s = speed_cap_m_s(state, limits.speed_m_s);
    if (cap_m_s < limits.speed_m_s)
      add(excesses, {limit_named("speed"), body.speed_m_s, cap_m_s, time_s, state});
  }

  /// The lowest cap of zones and mask at a place.
  double speed_cap_m_s(const SampledState& state, double limit_m_s) const {
    double cap_m_s = kNoLimit;
    for (const SpeedZone& zone : mission.speed_zones)
      if (zone.leg == leg && state.arc_length_m > zone.from_m && state.arc_length_m < zone.to_m)
        cap_m_s = std::min(cap_m_s, zone.speed_m_s);
    if (world.speed_mask)
      if (const auto masked = world.speed_mask->speed_cap_m_s(state.pose.x_m, state.pose.y_m, limit_m_s))
        cap_m_s = std::min(cap_m_s, *masked);
    return cap_m_s;
  }

  /// The acceleration is constant between samples: wherever it changes it jumps, and no finite jerk limit
  /// allows that. A coasting robot is exempt: nothing commands its acceleration.
  void look_for_jumps(double limit_m_s3, std::vector<Excess>& excesses) const {
    constexpr double kJump_m_s2 = 1e-5;  // rounding of differences is far below
    if (mission.legs[leg].motion->profile == MotionProfile::coast) return;
    const Trajectory& motion = *planned.prescribed;
    double before_m_s2 = 0.0;
    for (std::size_t k = 0; k < motion.size(); ++k) {
      const double time_s = motion.time_s[k];
      double after_m_s2 = 0.0;
      if (k + 1 < motion.size())
        after_m_s2 = sampled_state(motion, 0.5 * (time_s + motion.time_s[k + 1])).motion.acceleration_m_s2;
      if (std::abs(after_m_s2 - before_m_s2) > kJump_m_s2)
        add(excesses, {limit_named("jerk"), kNoLimit, limit_m_s3, time_s, sampled_state(motion, time_s),
                       std::abs(after_m_s2 - before_m_s2)});
      before_m_s2 = after_m_s2;
    }
  }
};

/// Curves, four control points (x, y) each, along which a prescribed motion drives forward, in the robot's
/// frame at the start.
std::vector<BezierPoints> driven_curves(const PrescribedMotion& motion, double distance_m) {
  if (!motion.bezier_m.empty()) return motion.bezier_m;
  if (motion.profile != MotionProfile::arc)
    return {{{{0, 0}, {distance_m / 3, 0}, {2 * distance_m / 3, 0}, {distance_m, 0}}}};
  const double radius_m = motion.radius_m.value_or(0.0), angle_rad = motion.angle_rad.value_or(0.0);
  const double count = std::ceil(std::abs(angle_rad) / 1.6), part_rad = std::abs(angle_rad) / count;
  const double side = angle_rad < 0 ? -1 : 1, handle_m = 4.0 / 3 * std::tan(part_rad / 4) * radius_m;
  const auto point = [&](double at_rad, double along_m) {
    return std::array{radius_m * std::sin(at_rad) + along_m * std::cos(at_rad),
                      side * (radius_m * (1 - std::cos(at_rad)) + along_m * std::sin(at_rad))};
  };
  std::vector<BezierPoints> curves;
  for (double from = 0; curves.size() < static_cast<std::size_t>(count); from += part_rad)
    curves.push_back({point(from, 0), point(from, handle_m), point(from + part_rad, -handle_m),
                      point(from + part_rad, 0)});
  return curves;
}

/// What to write instead of a motion that jumps.
std::string way_out(const PrescribedMotion& motion, double distance_m, double limit_m_s3) {
  std::ostringstream text;
  if (motion.reverse) {
    text << "; without jerk_m_s3 in the robot's limits it is driven";
    return text.str();
  }
  text << "; instead of `motion:` write `path: {bezier_m: [";
  const char* between = "";
  for (const BezierPoints& curve : driven_curves(motion, distance_m)) {
    text << between << "[";
    for (std::size_t k = 0; k < curve.size(); ++k)
      text << (k ? ", " : "") << "[" << curve[k][0] << ", " << curve[k][1] << "]";
    text << "]", between = ", ";
  }
  text << "]}`: then the planner finds the speeds within jerk_m_s3 = " << limit_m_s3;
  return text.str();
}

/// The verdict on the first of the limits that a motion exceeds. It offers a relaxation only if that is
/// enough: no other limit is exceeded and the value is finite.
Infeasibility verdict_of(const std::vector<Excess>& excesses, const PrescribedMotion& motion,
                         double distance_m) {
  const Excess& worst = excesses.front();
  Infeasibility verdict{.constraint = std::string(worst.row->name),
                        .s = worst.state.arc_length_m,
                        .x_m = worst.state.pose.x_m,
                        .y_m = worst.state.pose.y_m,
                        .amount = worst.amount(),
                        .unit = std::string(worst.row->unit)};
  std::ostringstream text;
  text.precision(4);
  if (std::isfinite(worst.value)) {
    if (excesses.size() == 1) verdict.relaxation[std::string(worst.row->key)] = std::abs(worst.value);
    text << sentence(verdict) << "; the prescribed motion does this at t = " << worst.time_s << " s";
  } else {
    verdict.amount = worst.jump_m_s2;
    verdict.unit = "m/s^2";
    text << "the prescribed acceleration jumps by " << worst.jump_m_s2 << " m/s^2 at t = " << worst.time_s
         << " s, and steps of acceleration keep no limit of jerk" << way_out(motion, distance_m, worst.limit);
  }
  for (std::size_t i = 1; i < excesses.size(); ++i)
    text << (i == 1 ? "; it exceeds also " : ", ") << excesses[i].row->name << " by " << excesses[i].amount()
         << " " << excesses[i].row->unit;
  verdict.message = text.str();
  return verdict;
}

}  // namespace

std::optional<Infeasibility> broken_limit(const LegPlan& planned, std::size_t leg,
                                          const MissionRequest& mission, const MissionWorld& world,
                                          const Plant& plant) {
  const LimitSearch search{planned, leg, mission, world, plant};
  std::vector<Excess> worst = search.worst();
  if (worst.empty()) return std::nullopt;
  const auto less = [](const Excess& x, const Excess& y) {
    return limit_fraction(x.value, x.limit) < limit_fraction(y.value, y.limit);
  };
  std::iter_swap(worst.begin(), std::max_element(worst.begin(), worst.end(), less));
  return verdict_of(worst, *mission.legs[leg].motion, planned.distance_m);
}

}  // namespace joulepath
