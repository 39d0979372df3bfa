#include <algorithm>
#include <cmath>
#include <cstdio>

#include "extensions/nav2/exports.hpp"
#include "extensions/nav2/leg_settings.hpp"
#include "scenarios/export/exports.hpp"

namespace joulepath {
namespace {

/// Settings from which those of every controller follow; without turns or curves in the mission, the robot's
/// limits. The yaw motion along curves follows from the path, so no setting may be below its limits.
LegSettings common_settings(const Plan& plan, const Limits& limits) {
  LegSettings settings = mission_settings(plan);
  const auto finite = [](double value) { return std::min(value, TrapezoidFamily::kUnlimited); };
  const double yaw = finite(limits.yaw_acceleration_rad_s2);
  if (!settings.drive)
    settings.drive = {finite(limits.speed_m_s), finite(limits.acceleration_m_s2),
                      finite(limits.deceleration_m_s2)};
  if (!settings.turn) settings.turn = {finite(limits.yaw_rate_rad_s), yaw, yaw};
  settings.yaw_rate_rad_s = settings.turn->rate;
  settings.yaw_acceleration_rad_s2 = settings.turn->acceleration;
  for_each_stretch(plan, [&](const StretchPlace&, const StretchPlan& stretch) {
    if (is_turn(stretch.request.piece) || !LocalLimits(stretch.request).curves()) return;
    const Limits& own = stretch.request.limits;
    settings.yaw_rate_rad_s = std::max(settings.yaw_rate_rad_s, finite(own.yaw_rate_rad_s));
    settings.yaw_acceleration_rad_s2 =
        std::max(settings.yaw_acceleration_rad_s2, finite(own.yaw_acceleration_rad_s2));
  });
  return settings;
}

/// With a decimal point, which parameters of type double need.
std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6f", value);
  std::string digits = text;
  digits.erase(std::max(digits.find_last_not_of('0') + 1, digits.find('.') + 2));
  return digits;
}

ControllerLoss loss_with(const Plan& plan, const LegSettings& settings) {
  return loss_of(plan, drive_with(plan, std::vector<LegSettings>(plan.legs.size(), settings)));
}

std::string loses(const Plan& plan, const ControllerLoss& loss) {
  constexpr double kSameTime_s = 0.005;
  const LossAtTime &own = loss.own_time, &at = loss.plan_time ? *loss.plan_time : own;
  const double early_s = plan.duration_s - own.duration_s;
  char text[300];
  if (early_s < -kSameTime_s)
    std::snprintf(
        text, sizeof text,
        "%.2f s, %.1f J: %.2f s after the plan; the least energy in that time is %.1f J, %.1f %% less",
        own.duration_s, own.energy_J, -early_s, at.optimum_J, at.lost_percent());
  else if (early_s > kSameTime_s)
    std::snprintf(
        text, sizeof text,
        "%.2f s, %.1f J: %.2f s before the plan, %.1f J with standby until then; the plan's %.1f J are "
        "%.1f %% less",
        own.duration_s, own.energy_J, early_s, at.energy_J, at.optimum_J, at.lost_percent());
  else
    std::snprintf(text, sizeof text, "%.2f s, %.1f J; the plan's %.1f J in the same time are %.1f %% less",
                  own.duration_s, own.energy_J, at.optimum_J, at.lost_percent());
  return text + (loss.broken_limit.empty() ? "" : "; exceeds a limit: " + loss.broken_limit);
}

/// What one set of settings allows in reverse.
double reverse_rate(const LegSettings& s, const Limits& limits) {
  return std::min(s.drive->rate, limits.reverse_speed_m_s);
}

std::string velocity_smoother(const LegSettings& s, const Limits& limits) {
  const std::string speed = number(s.drive->rate), yaw_rate = number(s.yaw_rate_rad_s),
                    reverse = number(reverse_rate(s, limits));
  const std::string yaw_acceleration = number(s.yaw_acceleration_rad_s2);
  return "velocity_smoother:\n  ros__parameters:\n    feedback: OPEN_LOOP\n    max_velocity: [" + speed +
         ", 0.0, " + yaw_rate + "]\n    min_velocity: [-" + reverse + ", 0.0, -" + yaw_rate +
         "]\n    max_accel: [" + number(s.drive->acceleration) + ", 0.0, " + yaw_acceleration +
         "]\n    max_decel: [-" + number(s.drive->deceleration) + ", 0.0, -" + yaw_acceleration + "]\n";
}

std::string mppi(const LegSettings& s) {
  return "# controller_server, MPPI:\n#   FollowPath:\n#     plugin: nav2_mppi_controller::MPPIController\n# "
         "    vx_max: " +
         number(s.drive->rate) + "\n#     wz_max: " + number(s.yaw_rate_rad_s) +
         "\n#     ax_max: " + number(s.drive->acceleration) + "\n#     ax_min: -" +
         number(s.drive->deceleration) + "\n#     az_max: " + number(s.yaw_acceleration_rad_s2) + "\n";
}

std::string rpp(const LegSettings& s) {
  return "controller_server:\n  ros__parameters:\n    FollowPath:\n"
         "      plugin: nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController\n"
         "      desired_linear_vel: " +
         number(s.drive->rate) +
         "\n      use_rotate_to_heading: true\n"
         "      rotate_to_heading_angular_vel: " +
         number(s.turn->rate) + "\n      max_angular_accel: " + number(s.turn->acceleration) + "\n";
}

std::string diff_drive(const LegSettings& s, const Limits& limits) {
  const auto axis = [](double rate, double reverse, double up, double down) {
    return "max_velocity: " + number(rate) + ", min_velocity: -" + number(reverse) +
           ", max_acceleration: " + number(up) + ", max_deceleration: -" + number(down);
  };
  return "diff_drive_controller:\n  ros__parameters:\n    linear:\n      x: {" +
         axis(s.drive->rate, reverse_rate(s, limits), s.drive->acceleration, s.drive->deceleration) +
         "}\n    angular:\n      z: {" +
         axis(s.yaw_rate_rad_s, s.yaw_rate_rad_s, s.yaw_acceleration_rad_s2, s.yaw_acceleration_rad_s2) +
         "}\n";
}

}  // namespace

Export export_nav2_settings(const ExportInput& input) {
  const Plan& plan = input.plan;
  const auto driven = std::find_if(plan.legs.begin(), plan.legs.end(),
                                   [](const LegPlan& leg) { return !leg.stretches.empty(); });
  if (driven == plan.legs.end())
    throw ConfigError({{input.mission.file, 0, 0},
                       "legs",
                       "nothing that is driven along a path",
                       "a leg with to: or path:",
                       ""});
  const Limits& limits = *input.world.robot.limits;
  const LegSettings all = common_settings(plan, driven->stretches.front().request.limits);
  const double any = TrapezoidFamily::kUnlimited;
  LegSettings no_pursuit = all, pursuit{.drive = all.drive, .turn = all.turn};
  no_pursuit.turn = {all.yaw_rate_rad_s, all.yaw_acceleration_rad_s2, all.yaw_acceleration_rad_s2};
  pursuit.drive->acceleration = pursuit.drive->deceleration = any;  // pure pursuit limits neither
  const ControllerLoss loss = loss_with(plan, all);
  const std::string text =
      "# Settings of least energy for mission " + plan.mission +
      ": one set of speeds and accelerations in the plan's time.\n# All sections: " + loses(plan, loss) +
      "\n# Without pure pursuit: " + loses(plan, loss_with(plan, no_pursuit)) +
      "\n# Pure pursuit alone: " + loses(plan, loss_with(plan, pursuit)) + "\n" +
      velocity_smoother(all, limits) + rpp(all) + mppi(all) + diff_drive(all, limits);
  return {.files = {{input.out_file, text}}, .loss = loss};
}

}  // namespace joulepath
