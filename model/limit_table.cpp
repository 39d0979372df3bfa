#include "model/limit_table.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/battery_sag.hpp"
#include "model/power.hpp"

namespace joulepath {
namespace {

using Points = std::vector<std::pair<double, double>>;  // payload, limit

double between(const std::pair<double, double>& before, const std::pair<double, double>& after,
               double payload_kg) {
  const auto& [x0, y0] = before;
  const auto& [x1, y1] = after;
  if (payload_kg >= x1) return y1;
  if (std::isinf(y0) || std::isinf(y1)) return std::min(y0, y1);
  return y0 + (y1 - y0) * (payload_kg - x0) / (x1 - x0);
}

double interpolate(const Points& points, double payload_kg) {
  if (payload_kg <= points.front().first) return points.front().second;
  for (std::size_t i = 1; i < points.size(); ++i)
    if (payload_kg <= points[i].first) return between(points[i - 1], points[i], payload_kg);
  return points.back().second;
}

/// A limit at the payloads of the rows; empty if no row names it.
Points points_of(const Robot& robot, const std::string& key, double base) {
  Points points;
  bool named = false;
  for (const PayloadLimits& row : robot.limits_by_payload) {
    const auto found = row.limit_by_key.find(key);
    named = named || found != row.limit_by_key.end();
    points.emplace_back(row.payload_kg, found == row.limit_by_key.end() ? base : found->second);
  }
  if (!named) points.clear();
  std::sort(points.begin(), points.end());
  return points;
}

}  // namespace

LimitState limit_state(const Plant& plant, const BodyMotion<double>& motion, const Site& site,
                       double speed_gain_m_s2, double jerk_m_s3) {
  const Robot& robot = plant.robot;
  const Sided<WheelState<double>> wheels = operating_point(plant, motion, site);
  const double battery_W =
      supply_power_W(robot.power, {wheels.left.power_W, wheels.right.power_W}) + robot.power.standby_W;
  return {.plant = plant,
          .site = site,
          .motion = motion,
          .speed_gain_m_s2 = speed_gain_m_s2,
          .jerk_m_s3 = jerk_m_s3,
          .wheel_acceleration_rad_s2 =
              wheel_speeds_rad_s(robot.geometry, motion.acceleration_m_s2, motion.yaw_acceleration_rad_s2),
          .wheels = wheels,
          .normal_load_N = 0.5 * robot.total_mass_kg(plant.payload_kg(site.payload_kg)) * kGravity_m_s2,
          .battery_power_W = battery_W,
          .battery_sag_V = BatterySag(robot.battery)(battery_W)};
}

const Limit* limit_named(std::string_view name) {
  const auto row =
      std::find_if(kLimits.begin(), kLimits.end(), [&](const Limit& r) { return r.name == name; });
  return row == kLimits.end() ? nullptr : &*row;
}

const Limit& payload_limit() { return *limit_named("max_payload"); }

double payload_limit_kg(const Robot& robot) {
  return robot.limits ? (*robot.limits).*payload_limit().field : kNoLimit;
}

double limit_of(const Limit& row, const Limits& limits, const Sided<Motor>& motor, Side side) {
  return row.field != nullptr ? limits.*row.field : motor[side].*row.rating;
}

double limit_fraction(double value, double limit) {
  constexpr double kNothing = 1e-12;  // rounding, where the limit is zero
  const double size = std::abs(value);
  if (limit <= 0) return size <= kNothing ? 0.0 : kNoLimit;
  return size / limit;
}

Limits limits_for_payload(const Robot& robot, double payload_kg) {
  Limits limits = robot.limits.value_or(Limits{});
  for (const Limit& row : kLimits) {
    if (row.field == nullptr || !row.by_payload) continue;
    const Points points = points_of(robot, std::string(row.key), limits.*row.field);
    if (!points.empty()) limits.*row.field = interpolate(points, payload_kg);
  }
  return limits;
}

Limits limits_between_payloads(const Robot& robot, double from_kg, double to_kg) {
  const auto [least_kg, most_kg] = std::minmax(from_kg, to_kg);
  Limits limits = limits_for_payload(robot, least_kg);
  const auto take_smaller = [&](double payload_kg) {
    const Limits other = limits_for_payload(robot, payload_kg);
    for (const Limit& row : kLimits)
      if (row.field != nullptr) limits.*row.field = std::min(limits.*row.field, other.*row.field);
  };
  take_smaller(most_kg);
  for (const PayloadLimits& row : robot.limits_by_payload)
    if (row.payload_kg > least_kg && row.payload_kg < most_kg) take_smaller(row.payload_kg);
  return limits;
}

}  // namespace joulepath
