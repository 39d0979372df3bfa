#include <algorithm>
#include <cmath>
#include <cstdio>

#include "planner/controller/leg_settings.hpp"
#include "scenarios/export/exports.hpp"

namespace joulepath {
namespace {

/// Speeds from which the settings of every controller follow; without turns or curves in the mission, the
/// robot's limits.
struct Speeds {
  TrapezoidSettings drive{}, turn{};
};

Speeds speeds_of(const Plan& plan) {
  const LegSettings settings = mission_settings(plan);
  const Limits& limits = plan.legs.front().stretches.front().request.limits;
  const auto finite = [](double value) { return std::min(value, TrapezoidFamily::kUnlimited); };
  const double yaw = finite(limits.yaw_acceleration_rad_s2);
  return {settings.drive.value_or(TrapezoidSettings{
              finite(limits.speed_m_s), finite(limits.acceleration_m_s2), finite(limits.deceleration_m_s2)}),
          settings.turn.value_or(TrapezoidSettings{finite(limits.yaw_rate_rad_s), yaw, yaw})};
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", value);
  return text;
}

std::string loses(const ControllerLoss& loss, const Plan& plan) {
  char text[240];
  const LossAtTime& own = loss.own_time;
  std::snprintf(text, sizeof text,
                "%.1f s (plan: %.1f s), %.0f J; the plan takes %.0f J in that time: %.0f J lost",
                own.duration_s, plan.duration_s, own.energy_J, own.optimum_J,
                std::abs(own.lost_J()) < 0.5 ? 0.0 : own.lost_J());
  return text;
}

/// Yaw rates in curves follow from the path; the controller's limit must not be below them.
double most_yaw_rate(const Plan& plan, const Speeds& speeds) {
  double most = speeds.turn.rate;
  for (const LegPlan& leg : plan.legs)
    for (const StretchPlan& stretch : leg.stretches)
      if (!is_turn(stretch.request.piece))
        most = std::max(most, std::min(stretch.request.limits.yaw_rate_rad_s, TrapezoidFamily::kUnlimited));
  return most;
}

std::string velocity_smoother(const Speeds& s, double yaw_rate) {
  return "velocity_smoother:\n  ros__parameters:\n    feedback: OPEN_LOOP\n    max_velocity: [" +
         number(s.drive.rate) + ", 0.0, " + number(yaw_rate) + "]\n    min_velocity: [-" +
         number(s.drive.rate) + ", 0.0, -" + number(yaw_rate) + "]\n    max_accel: [" +
         number(s.drive.acceleration) + ", 0.0, " + number(s.turn.acceleration) + "]\n    max_decel: [-" +
         number(s.drive.deceleration) + ", 0.0, -" + number(s.turn.deceleration) + "]\n";
}

std::string mppi(const Speeds& s, double yaw_rate) {
  return "# controller_server, MPPI:\n#   FollowPath:\n#     plugin: nav2_mppi_controller::MPPIController\n# "
         "    vx_max: " +
         number(s.drive.rate) + "\n#     wz_max: " + number(yaw_rate) +
         "\n#     ax_max: " + number(s.drive.acceleration) + "\n#     ax_min: -" +
         number(s.drive.deceleration) + "\n#     az_max: " + number(s.turn.acceleration) + "\n";
}

std::string rpp(const Speeds& s) {
  return "controller_server:\n  ros__parameters:\n    FollowPath:\n"
         "      plugin: nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController\n"
         "      desired_linear_vel: " +
         number(s.drive.rate) +
         "\n      use_rotate_to_heading: true\n"
         "      rotate_to_heading_angular_vel: " +
         number(s.turn.rate) + "\n      max_angular_accel: " + number(s.turn.acceleration) + "\n";
}

std::string diff_drive(const Speeds& s, double yaw_rate) {
  const auto axis = [](double rate, double up, double down) {
    return "max_velocity: " + number(rate) + ", min_velocity: -" + number(rate) +
           ", max_acceleration: " + number(up) + ", max_deceleration: -" + number(down);
  };
  return "diff_drive_controller:\n  ros__parameters:\n    linear:\n      x: {" +
         axis(s.drive.rate, s.drive.acceleration, s.drive.deceleration) + "}\n    angular:\n      z: {" +
         axis(yaw_rate, s.turn.acceleration, s.turn.deceleration) + "}\n";
}

}  // namespace

Export export_nav2_settings(const ExportInput& input) {
  if (input.plan.legs.empty() || input.plan.legs.front().stretches.empty())
    throw ConfigError({{input.mission.file, 0, 0},
                       "legs",
                       "nothing that is driven along a path",
                       "a leg with to: or path:",
                       ""});
  const Speeds speeds = speeds_of(input.plan);
  const double yaw_rate = most_yaw_rate(input.plan, speeds);
  const std::vector<LegSettings> legs(input.plan.legs.size(), {.drive = speeds.drive, .turn = speeds.turn});
  const ControllerLoss loss = loss_of(input.plan, drive_with(input.plan, legs));
  // Pure pursuit has no limit of linear acceleration, so the limits of the drives apply.
  std::vector<LegSettings> steep = legs;
  const Limits& limits = input.plan.legs.front().stretches.front().request.limits;
  for (LegSettings& leg : steep) {
    leg.drive->acceleration = std::min(limits.acceleration_m_s2, TrapezoidFamily::kUnlimited);
    leg.drive->deceleration = std::min(limits.deceleration_m_s2, TrapezoidFamily::kUnlimited);
  }
  const ControllerLoss loss_alone = loss_of(input.plan, drive_with(input.plan, steep));
  const std::string text =
      "# Settings of least energy for mission " + input.plan.mission +
      ": one set of speeds and accelerations that takes the plan's time.\n# Velocity smoother, "
      "MPPI, diff_drive_controller, or pure pursuit with one of them: " +
      loses(loss, input.plan) + "\n# Pure pursuit without any of them: " + loses(loss_alone, input.plan) +
      "\n" + velocity_smoother(speeds, yaw_rate) + rpp(speeds) + mppi(speeds, yaw_rate) +
      diff_drive(speeds, yaw_rate);
  return {.files = {{input.out_file, text}}, .loss = loss};
}

}  // namespace joulepath
