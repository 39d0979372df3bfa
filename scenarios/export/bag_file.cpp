#include <cmath>
#include <nlohmann/json.hpp>

#include "planner/accounts/plan_trajectory.hpp"
#include "scenarios/bags/mcap_writer.hpp"
#include "scenarios/bags/ros_definitions.hpp"
#include "scenarios/export/exports.hpp"

namespace joulepath {
namespace {

constexpr double kBagRate_Hz = 50.0;
constexpr std::string_view kFrame = "map";

constexpr const char* kPowerSchema = R"({"title": "joulepath/power/1", "type": "object", "properties": {
  "battery_power_W": {"type": "number"}, "energy_J": {"type": "number"},
  "motor_power_left_W": {"type": "number"}, "motor_power_right_W": {"type": "number"},
  "motor_current_left_A": {"type": "number"}, "motor_current_right_A": {"type": "number"}}})";

BagChannel ros_channel(const std::string& topic, const std::string& type) {
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

std::string power(const Trajectory& motion, std::size_t k) {
  return nlohmann::ordered_json{{"battery_power_W", motion.battery_power_W[k]},
                                {"energy_J", motion.energy_J[k]},
                                {"motor_power_left_W", motion.motor_power_W.left[k]},
                                {"motor_power_right_W", motion.motor_power_W.right[k]},
                                {"motor_current_left_A", motion.motor_current_A.left[k]},
                                {"motor_current_right_A", motion.motor_current_A.right[k]}}
      .dump();
}

}  // namespace

Export export_bag(const ExportInput& input) {
  const Trajectory motion = plan_trajectory(input.plan, input.plant, input.rate_Hz.value_or(kBagRate_Hz));
  McapWriter bag;
  const auto path_channel = bag.channel(ros_channel("/plan/path", "nav_msgs/msg/Path"));
  const auto odometry_channel = bag.channel(ros_channel("/plan/odom", "nav_msgs/msg/Odometry"));
  const auto power_channel = bag.channel({.topic = "/plan/power",
                                          .type = "joulepath/power/1",
                                          .schema_encoding = "jsonschema",
                                          .schema = kPowerSchema,
                                          .encoding = "json"});
  bag.message(path_channel, 0, path(motion));
  for (std::size_t k = 0; k < motion.size(); ++k) {
    const std::uint64_t time_ns = nanoseconds(motion.time_s[k]);
    bag.message(odometry_channel, time_ns, odometry(motion, k));
    bag.message(power_channel, time_ns, power(motion, k));
  }
  return {.files = {{input.out_file, bag.finish()}}};
}

}  // namespace joulepath
