#include "planner/motion/limits_for_payload.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace joulepath {
namespace {

const std::map<std::string, double Limits::*>& limit_members() {
  static const std::map<std::string, double Limits::*> members{
      {"speed_m_s", &Limits::speed_m_s},
      {"acceleration_m_s2", &Limits::acceleration_m_s2},
      {"deceleration_m_s2", &Limits::deceleration_m_s2},
      {"lateral_acceleration_m_s2", &Limits::lateral_acceleration_m_s2},
      {"yaw_rate_rad_s", &Limits::yaw_rate_rad_s},
      {"yaw_acceleration_rad_s2", &Limits::yaw_acceleration_rad_s2},
      {"wheel_acceleration_rad_s2", &Limits::wheel_acceleration_rad_s2},
      {"jerk_m_s3", &Limits::jerk_m_s3},
      {"traction_coefficient", &Limits::traction_coefficient},
      {"motor_power_W", &Limits::motor_power_W},
      {"battery_power_W", &Limits::battery_power_W},
      {"max_payload_kg", &Limits::max_payload_kg}};
  return members;
}

double interpolate(const std::vector<std::pair<double, double>>& points, double payload_kg) {
  if (payload_kg <= points.front().first) return points.front().second;
  for (std::size_t i = 1; i < points.size(); ++i)
    if (payload_kg <= points[i].first) {
      const auto& [x0, y0] = points[i - 1];
      const auto& [x1, y1] = points[i];
      return x1 > x0 ? y0 + (y1 - y0) * (payload_kg - x0) / (x1 - x0) : y1;
    }
  return points.back().second;
}

}  // namespace

Limits limits_for_payload(const Robot& robot, double payload_kg) {
  Limits limits = robot.limits.value_or(Limits{});
  std::map<std::string, std::vector<std::pair<double, double>>> points;
  for (const PayloadLimits& row : robot.limits_by_payload)
    for (const auto& [key, limit] : row.limit_by_key) points[key].emplace_back(row.payload_kg, limit);
  for (auto& [key, rows] : points) {
    std::sort(rows.begin(), rows.end());
    const auto member = limit_members().find(key);
    if (member != limit_members().end()) limits.*(member->second) = interpolate(rows, payload_kg);
  }
  return limits;
}

}  // namespace joulepath
