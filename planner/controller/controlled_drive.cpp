#include "planner/controller/controlled_drive.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/baselines/comparison.hpp"
#include "planner/baselines/finish.hpp"
#include "planner/baselines/rounded.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/profile/profile_solver.hpp"
#include "planner/values/verdict_text.hpp"

// Design: docs/decisions/0401-controllers-and-graphs.md
namespace joulepath {
namespace {

/// Shares of the yaw acceleration that a change of curvature may use, fastest first.
constexpr std::array<double, 5> kCurveShares{1.0, 0.9, 0.75, 0.5, 0.25};
constexpr double kSameTime = 1e-6;

BaselineResult drive_trapezoids(const ProfileRequest& request, const TrapezoidFamily& family,
                                TrapezoidSettings settings) {
  std::optional<BaselineResult> best;
  for (const double share : kCurveShares) {
    settings.curve_share = share;
    if (!family.squares(settings)) continue;
    Profile profile = family.profile(settings);
    const double duration_s = profile.time_s.back();
    BaselineResult result =
        finish_baseline(request, "controller", std::move(profile), duration_s, family.parameters(settings));
    if (result.feasible) return result;
    if (!best) best = std::move(result);
    if (!family.curves()) break;
  }
  return best ? std::move(*best) : no_baseline("controller", "cannot keep the speeds at the ends");
}

TrapezoidSettings least_of(const TrapezoidSettings& one, const TrapezoidSettings& other) {
  return {std::min(one.rate, other.rate), std::min(one.acceleration, other.acceleration),
          std::min(one.deceleration, other.deceleration)};
}

/// Under a jerk limit the corners of a controller's trapezoids are rounded: as fast as its settings allow.
BaselineResult drive_under_jerk(const ProfileRequest& request, const TrapezoidSettings& settings) {
  ProfileRequest fastest = request;
  fastest.limits.speed_m_s = std::min(fastest.limits.speed_m_s, settings.rate);
  fastest.limits.acceleration_m_s2 = std::min(fastest.limits.acceleration_m_s2, settings.acceleration);
  fastest.limits.deceleration_m_s2 = std::min(fastest.limits.deceleration_m_s2, settings.deceleration);
  fastest.time = {.mode = TimeMode::minimum_time};
  fastest.solver = SolverChoice::fast;
  std::optional<Profile> profile = solve_profile(fastest).profile;
  if (!profile) return no_baseline("controller", "cannot keep the speeds at the ends");
  const double duration_s = profile->time_s.back();
  return finish_baseline(request, "controller", std::move(*profile), duration_s,
                         {{"jerk_m_s3", request.limits.jerk_m_s3}});
}

/// Least energy of a stretch in a time; `otherwise` if no profile is as fast.
double optimum_J(const StretchPlan& stretch, double duration_s, double otherwise_J) {
  const std::optional<EnergyByCause> least = least_energy(stretch.request, duration_s);
  return least ? least->total_J() : otherwise_J;
}

}  // namespace

void for_each_stretch(const Plan& plan,
                      const std::function<void(const StretchPlace&, const StretchPlan&)>& visit) {
  for (std::size_t leg = 0; leg < plan.legs.size(); ++leg) {
    double from_m = 0;
    const std::vector<StretchPlan>& stretches = plan.legs[leg].stretches;
    for (std::size_t k = 0; k < stretches.size(); ++k) {
      visit({leg, k, from_m}, stretches[k]);
      if (!is_turn(stretches[k].request.piece)) from_m += piece_length(stretches[k].request.piece);
    }
  }
}

TrapezoidSettings fastest_settings(const StretchPlace& /*place*/, const StretchPlan& stretch) {
  const Limits& limits = stretch.request.limits;
  const double limit = is_turn(stretch.request.piece) ? limits.yaw_rate_rad_s : limits.speed_m_s;
  return {std::min(limit, TrapezoidFamily::kUnlimited), most_acceleration(stretch.request),
          most_deceleration(stretch.request)};
}

BaselineResult controlled_stretch(const ProfileRequest& request, const TrapezoidSettings& settings) {
  if (is_rounded(request)) return drive_under_jerk(request, settings);
  return with_room(request, [&](const ProfileRequest& inner) {
    const TrapezoidFamily family(inner);
    const TrapezoidSettings most{settings.rate, family.most_acceleration(), family.most_deceleration()};
    return drive_trapezoids(request, family, least_of(settings, most));
  });
}

ControlledDrive drive_by_controller(const Plan& plan, const StretchSettings& settings,
                                    const StretchCaps& caps) {
  // Parts that the controller does not drive are as in the plan: dwells, waits, prescribed motions.
  ControlledDrive drive{.energy_J = plan.energy.total_J(),
                        .motion_energy_J = plan.energy.motion_J(),
                        .duration_s = plan.duration_s};
  for_each_stretch(plan, [&](const StretchPlace& place, const StretchPlan& stretch) {
    ProfileRequest request = stretch.request;
    if (caps)
      for (const SpeedCap& cap : caps(place, stretch)) request.speed_caps.push_back(cap);
    BaselineResult result =
        controlled_stretch(request, least_of(settings(place, stretch), fastest_settings(place, stretch)));
    drive.energy_J += result.energy_J - stretch.energy.total_J();
    drive.motion_energy_J += result.motion_energy_J - stretch.energy.motion_J();
    drive.duration_s += result.duration_s - stretch.profile.duration_s();
    drive.stretch_s.push_back(result.duration_s);
    drive.profiles.push_back(std::move(result.profile).value_or(Profile{}));
    if (!result.feasible && drive.broken_limit.empty())
      drive.broken_limit = "leg " + leg_text(place.leg, plan.legs[place.leg].to) + ": " + result.reason;
  });
  return drive;
}

ControllerLoss loss_of(const Plan& plan, const ControlledDrive& drive) {
  ControllerLoss loss{.own_time = {drive.duration_s, drive.energy_J, plan.energy.total_J()},
                      .broken_limit = drive.broken_limit};
  double standby_W = 0;
  std::size_t index = 0;
  for_each_stretch(plan, [&](const StretchPlace&, const StretchPlan& stretch) {
    standby_W = stretch.request.plant.robot.power.standby_W;
    const double planned_J = stretch.energy.total_J(), taken_s = drive.stretch_s[index++];
    const bool same = std::abs(taken_s - stretch.profile.duration_s()) <= kSameTime * taken_s;
    if (!same) loss.own_time.optimum_J += optimum_J(stretch, taken_s, planned_J) - planned_J;
  });
  const double early_s = plan.duration_s - drive.duration_s;
  if (early_s >= -kSameTime * plan.duration_s)
    loss.plan_time = {plan.duration_s, drive.energy_J + standby_W * early_s, plan.energy.total_J()};
  return loss;
}

}  // namespace joulepath
