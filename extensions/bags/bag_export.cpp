#include "extensions/bags/bag_export.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "extensions/bags/bag_survey.hpp"
#include "extensions/bags/mcap_writer.hpp"
#include "extensions/bags/ros_definitions.hpp"
#include "model/kinematics.hpp"
#include "model/log_columns.hpp"
#include "planner/accounts/plan_trajectory.hpp"

namespace joulepath {
namespace {

constexpr double kBagRate_Hz = 50.0;
constexpr std::string_view kFrame = "map";
constexpr double kLastStamp_s = 2147483647.0;  ///< 32 bits hold the seconds of a stamp

/// The channels of the power messages of a plan; those of a log are all that it has beside its motion.
MessageChannel ros_channel(const std::string& topic, const std::string& type) {
  return {.topic = topic,
          .type = type,
          .schema_encoding = "ros2msg",
          .schema = ros_definition(type),
          .encoding = "cdr"};
}

std::uint64_t nanoseconds(double time_s) { return static_cast<std::uint64_t>(std::llround(1e9 * time_s)); }

void put_header(CdrWriter& out, double time_s) {
  constexpr std::uint64_t kSecond = 1'000'000'000;
  const std::uint64_t total = nanoseconds(time_s);
  out.number(static_cast<std::int32_t>(total / kSecond)).number(static_cast<std::uint32_t>(total % kSecond));
  out.text(kFrame);
}

void put_pose(CdrWriter& out, const Trajectory& motion, std::size_t k) {
  const double half_rad = 0.5 * motion.heading_rad[k];
  for (const double value : {motion.position_x_m[k], motion.position_y_m[k], 0.0, 0.0, 0.0,
                             std::sin(half_rad), std::cos(half_rad)})
    out.number(value);
}

void put_covariance(CdrWriter& out) {
  for (int i = 0; i < 36; ++i) out.number(0.0);
}

std::string odometry(const Trajectory& motion, std::size_t k) {
  CdrWriter out;
  put_header(out, motion.time_s[k]);
  out.text("base_link");
  put_pose(out, motion, k);
  put_covariance(out);
  for (const double value : {motion.linear_speed_m_s[k], 0.0, 0.0, 0.0, 0.0, motion.angular_speed_rad_s[k]})
    out.number(value);
  put_covariance(out);
  return out.bytes();
}

std::string path(const Trajectory& motion) {
  CdrWriter out;
  put_header(out, 0.0);
  out.number(static_cast<std::uint32_t>(motion.size()));
  for (std::size_t k = 0; k < motion.size(); ++k) {
    put_header(out, motion.time_s[k]);
    put_pose(out, motion, k);
  }
  return out.bytes();
}

using Json = nlohmann::ordered_json;

std::string power_schema(const std::vector<std::string>& columns) {
  Json properties = Json::object();
  for (const std::string& column : columns) properties[column] = {{"type", "number"}};
  return Json{{"title", kPowerType}, {"type", "object"}, {"properties", properties}}.dump();
}

std::string power(const Trajectory& motion, const std::vector<std::string>& columns, std::size_t k) {
  Json message = Json::object();
  for (const std::string& column : columns) message[column] = find_log_column(column)->of(motion)[k];
  return message.dump();
}

/// Names of the columns that a motion has.
std::vector<std::string> columns_of(const Trajectory& motion) {
  std::vector<std::string> columns;
  for (const LogColumn& column : log_columns())
    if (column.name != "time_s" && !column.of(motion).empty()) columns.push_back(column.name);
  return columns;
}

/// The bag of a motion, on topics below `prefix`.
std::string bag_of(const Trajectory& motion, const std::string& prefix,
                   const std::vector<std::string>& power_columns) {
  McapWriter bag;
  const auto path_channel = bag.channel(ros_channel(prefix + "/path", "nav_msgs/msg/Path"));
  const auto odometry_channel = bag.channel(ros_channel(prefix + "/odom", "nav_msgs/msg/Odometry"));
  const auto power_channel = bag.channel({.topic = prefix + "/power",
                                          .type = kPowerType,
                                          .schema_encoding = "jsonschema",
                                          .schema = power_schema(power_columns),
                                          .encoding = "json"});
  bag.message(path_channel, 0, path(motion));
  for (std::size_t k = 0; k < motion.size(); ++k) {
    const std::uint64_t time_ns = nanoseconds(motion.time_s[k]);
    bag.message(odometry_channel, time_ns, odometry(motion, k));
    bag.message(power_channel, time_ns, power(motion, power_columns, k));
  }
  return bag.finish();
}

/// Body speeds from the wheels', and a pose from the speeds, where the log has none [P1, Eqs. (2), (3)].
Trajectory with_body_motion(Trajectory log, const Geometry& geometry) {
  const std::size_t n = log.size();
  log.linear_speed_m_s.resize(n);
  log.angular_speed_rad_s.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Twist<double> body =
        body_twist(geometry, Sided<double>{log.wheel_speed_rad_s.left[k], log.wheel_speed_rad_s.right[k]});
    log.linear_speed_m_s[k] = body.speed_m_s;
    log.angular_speed_rad_s[k] = body.yaw_rate_rad_s;
  }
  if (!log.position_x_m.empty() && !log.position_y_m.empty() && !log.heading_rad.empty()) return log;
  Pose pose{};
  for (auto* channel : {&log.position_x_m, &log.position_y_m, &log.heading_rad}) channel->assign(n, 0.0);
  for (std::size_t k = 1; k < n; ++k) {
    const double step_s = log.time_s[k] - log.time_s[k - 1];
    const double middle_rad = pose.heading_rad + 0.5 * step_s * log.angular_speed_rad_s[k];
    pose = {pose.x_m + step_s * log.linear_speed_m_s[k] * std::cos(middle_rad),
            pose.y_m + step_s * log.linear_speed_m_s[k] * std::sin(middle_rad),
            pose.heading_rad + step_s * log.angular_speed_rad_s[k]};
    log.position_x_m[k] = pose.x_m;
    log.position_y_m[k] = pose.y_m;
    log.heading_rad[k] = pose.heading_rad;
  }
  return log;
}

}  // namespace

Export export_bag(const ExportInput& input) {
  const Trajectory motion = plan_trajectory(input.plan, input.plant, input.rate_Hz.value_or(kBagRate_Hz));
  return {.files = {{input.out_file, bag_of(motion, "/plan", columns_of(motion))}}};
}

std::string log_bag(const Trajectory& log, const Geometry& geometry) {
  Trajectory motion = with_body_motion(log, geometry);
  const double before_0_s = std::min(0.0, log.time_s.front());  // a stamp is not negative
  for (double& time_s : motion.time_s) time_s -= before_0_s;
  if (motion.time_s.back() > kLastStamp_s)
    throw ConfigError({{}, "time_s", std::to_string(motion.time_s.back()) + " s", "times below 2^31 s", ""});
  return bag_of(motion, "/log", columns_of(log));
}

}  // namespace joulepath
