#include "planner/legs/stretch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/battery_charge.hpp"
#include "model/battery_power.hpp"
#include "model/limit_table.hpp"
#include "planner/motion/path_motion.hpp"

namespace joulepath {
namespace {

/// Intervals of a curve on which the mask sets one cap. Their borders are those of the cells: two places half
/// a cell apart see whether the cap changes, bisection finds where.
void append_mask_caps(const Curve& curve, const SpeedMask& mask, double speed_limit_m_s,
                      std::vector<SpeedCap>& caps) {
  constexpr int kHalvings = 20;
  const double length_m = curve.length_m(), step_m = 0.5 * mask.grid.resolution_m;
  const auto cap_at = [&](double s_m) {
    const Pose pose = curve.at(s_m).pose;
    return mask.speed_cap_m_s(pose.x_m, pose.y_m, speed_limit_m_s);
  };
  const auto count = static_cast<std::size_t>(std::ceil(length_m / step_m));
  std::optional<double> cap_m_s = cap_at(0);
  double from_m = 0, last_m = 0;
  const auto append_until = [&](double s_m) {
    if (cap_m_s && s_m > from_m) caps.push_back({from_m, s_m, *cap_m_s});
  };
  for (std::size_t k = 1; k <= count; ++k) {
    const double s_m = std::min(length_m, static_cast<double>(k) * step_m);
    const std::optional<double> here = cap_at(s_m);
    if (here != cap_m_s) {
      double low_m = last_m, high_m = s_m;
      for (int i = 0; i < kHalvings; ++i) {
        const double middle_m = 0.5 * (low_m + high_m);
        (cap_at(middle_m) == cap_m_s ? low_m : high_m) = middle_m;
      }
      append_until(high_m);
      cap_m_s = here;
      from_m = high_m;
    }
    last_m = s_m;
  }
  append_until(length_m);
}

void leave_margins(ProfileRequest& request, const LimitShares& shares) {
  for (const auto& [name, share] : shares) {
    const Limit* named = limit_named(name);
    if (named == nullptr) continue;  // the windings' temperatures, which no profile knows
    const Limit& row = *named;
    if (row.field != nullptr) request.limits.*row.field *= share;
    for (const Side side : kSides)
      if (row.field == nullptr) request.plant.robot.motor[side].*row.rating *= share;
  }
}

}  // namespace

PlanOptions with_limit_shares(PlanOptions options, const LimitShares& shares) {
  if (shares.empty()) return options;
  ByteWriter writer;
  writer(options.answers.world.first, options.answers.world.second, shares);
  for (const auto& [name, share] : shares) options.limit_shares.try_emplace(name, 1.0).first->second *= share;
  options.answers.world = content_key(writer.bytes());
  return options;
}

Limits limits_along(const Robot& robot, const PayloadAlongLeg& payload) {
  Limits limits = limits_between_payloads(robot, payload.from_kg, payload.to_kg);
  limit_by_battery(limits, robot.battery);
  return limits;
}

void limit_by_battery(Limits& limits, const Battery& battery) {
  limits.battery_power_W = std::min(limits.battery_power_W, planned_battery_power_W(battery));
  limits.battery_voltage_V = std::min(limits.battery_voltage_V, motor_supply_V(battery));
  limits.charge_power_W = std::min(limits.charge_power_W, most_charge_power_W(battery));
}

// With a ramp of t the peak is j t^2 / 4, and both ramps together are peak t long.
double mean_ramp_m_s2(double length_m, const Limits& limits) {
  const double peak_m_s =
      std::min(limits.speed_m_s, std::cbrt(0.25 * limits.jerk_m_s3 * length_m * length_m));
  return 0.5 * std::sqrt(peak_m_s * limits.jerk_m_s3);
}

bool may_reverse(const Robot& robot, const LegRequest& leg) {
  return leg.direction != LegDirection::forward &&
         std::isfinite(limits_along(robot, leg.payload).reverse_speed_m_s);
}

std::vector<SpeedCap> speed_caps_on(const PathPiece& piece, double offset_m, std::size_t leg,
                                    const std::vector<SpeedZone>& zones, const std::optional<SpeedMask>& mask,
                                    double speed_limit_m_s) {
  std::vector<SpeedCap> caps;
  if (is_turn(piece)) return caps;
  const double length_m = piece_length(piece);
  for (const SpeedZone& zone : zones) {
    const double from_m = std::max(0.0, zone.from_m - offset_m);
    const double to_m = std::min(length_m, zone.to_m - offset_m);
    if (zone.leg == leg && from_m < to_m) caps.push_back({from_m, to_m, zone.speed_m_s});
  }
  if (mask) append_mask_caps(std::get<Curve>(piece), *mask, speed_limit_m_s, caps);
  return caps;
}

EffectMemory memory_after(const ProfileRequest& request) {
  return path_motion(request).memory(piece_length(request.piece));
}

std::vector<ProfileRequest> stretches_of(const Path& path, const LegRequest& leg, std::size_t leg_index,
                                         const MissionRequest& mission, const MissionWorld& world,
                                         const Plant& plant, const PlanOptions& options,
                                         EffectMemory memory) {
  Limits limits = limits_along(world.robot, leg.payload);
  if (leg.yaw_rate_rad_s) limits.yaw_rate_rad_s = std::min(limits.yaw_rate_rad_s, *leg.yaw_rate_rad_s);
  const double leg_length_m = path.distance_m();
  const auto payload_at_kg = [&](double s_m) {
    const double fraction = leg_length_m > 0 ? s_m / leg_length_m : 0.0;
    return leg.payload.from_kg + fraction * (leg.payload.to_kg - leg.payload.from_kg);
  };
  std::vector<ProfileRequest> requests;
  double offset_m = 0.0;
  for (const PathPiece& piece : path.pieces) {
    const double length_m = is_turn(piece) ? 0.0 : piece_length(piece);
    Limits here = limits;
    if (travel_sign(piece) < 0) here.speed_m_s = std::min(here.speed_m_s, here.reverse_speed_m_s);
    requests.push_back({.piece = piece,
                        .plant = plant,
                        .limits = here,
                        .payload = {payload_at_kg(offset_m), payload_at_kg(offset_m + length_m)},
                        .speed_caps = speed_caps_on(piece, offset_m, leg_index, mission.speed_zones,
                                                    world.speed_mask, limits.speed_m_s),
                        .nodes = options.nodes,
                        .accuracy = options.accuracy,
                        .solver = options.solver,
                        .memory = memory});
    leave_margins(requests.back(), options.limit_shares);
    memory = memory_after(requests.back());
    offset_m += length_m;
  }
  // Speeds at the ends are speeds of driving; prepared_legs.cpp refuses them at turns in place.
  if (!requests.empty() && !is_turn(requests.front().piece))
    requests.front().start_rate = leg.start_speed_m_s;
  if (!requests.empty() && !is_turn(requests.back().piece)) requests.back().end_rate = leg.end_speed_m_s;
  return requests;
}

}  // namespace joulepath
