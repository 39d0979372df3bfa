#include <cmath>
#include <nlohmann/json.hpp>

#include "planner/accounts/plan_trajectory.hpp"
#include "scenarios/export/exports.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kRate_Hz = 10.0;

/// builtin_interfaces/Time, counted from the mission's start.
Json stamp_json(double time_s) {
  constexpr long kNanoseconds = 1'000'000'000;
  const long total = std::lround(time_s * kNanoseconds);
  return {{"sec", total / kNanoseconds}, {"nanosec", total % kNanoseconds}};
}

Json header_json(double time_s) { return {{"stamp", stamp_json(time_s)}, {"frame_id", "map"}}; }

Json vector_json(double x, double y, double z) { return {{"x", x}, {"y", y}, {"z", z}}; }

Json pose_json(const Trajectory& motion, std::size_t k) {
  const double half_rad = 0.5 * motion.heading_rad[k];
  return {{"position", vector_json(motion.position_x_m[k], motion.position_y_m[k], 0.0)},
          {"orientation", {{"x", 0.0}, {"y", 0.0}, {"z", std::sin(half_rad)}, {"w", std::cos(half_rad)}}}};
}

/// Twist, Accel and Wrench of a planar motion have the same form.
Json planar_json(const char* linear, double along, const char* angular, double about) {
  return {{linear, vector_json(along, 0.0, 0.0)}, {angular, vector_json(0.0, 0.0, about)}};
}

/// Yaw acceleration (rad/s^2) by differences of the yaw rate.
double yaw_acceleration(const Trajectory& motion, std::size_t k) {
  const std::size_t from = k == 0 ? 0 : k - 1, to = std::min(k + 1, motion.size() - 1);
  const double length_s = motion.time_s[to] - motion.time_s[from];
  return length_s > 0 ? (motion.angular_speed_rad_s[to] - motion.angular_speed_rad_s[from]) / length_s : 0.0;
}

/// Force and moment of both wheels on the body: N forward, N m about its vertical axis.
Json effort_json(const Trajectory& motion, std::size_t k, const Geometry& geometry) {
  const double left_N = motion.wheel_torque_Nm.left[k] / geometry.wheel_radius_m.left;
  const double right_N = motion.wheel_torque_Nm.right[k] / geometry.wheel_radius_m.right;
  return planar_json("force", left_N + right_N, "torque", geometry.half_track_m * (right_N - left_N));
}

bool same_pose(const Trajectory& motion, std::size_t a, std::size_t b) {
  return motion.position_x_m[a] == motion.position_x_m[b] &&
         motion.position_y_m[a] == motion.position_y_m[b] && motion.heading_rad[a] == motion.heading_rad[b];
}

Export one_file(const ExportInput& input, const Json& json) {
  return {.files = {{input.out_file, json.dump(1) + "\n"}}};
}

}  // namespace

Export export_nav2_path(const ExportInput& input) {
  const Trajectory motion = plan_trajectory(input.plan, input.plant, input.rate_Hz.value_or(kRate_Hz));
  Json poses = Json::array();
  for (std::size_t k = 0; k < motion.size(); ++k)
    if (k == 0 || k + 1 == motion.size() || !same_pose(motion, k, k - 1))
      poses.push_back({{"header", header_json(motion.time_s[k])}, {"pose", pose_json(motion, k)}});
  return one_file(input, {{"header", header_json(0.0)}, {"poses", std::move(poses)}});
}

Export export_trajectory(const ExportInput& input) {
  const Trajectory motion = plan_trajectory(input.plan, input.plant, input.rate_Hz.value_or(kRate_Hz));
  Json points = Json::array();
  for (std::size_t k = 0; k < motion.size(); ++k)
    points.push_back({{"header", header_json(motion.time_s[k])},
                      {"pose", pose_json(motion, k)},
                      {"velocity", planar_json("linear", motion.linear_speed_m_s[k], "angular",
                                               motion.angular_speed_rad_s[k])},
                      {"acceleration", planar_json("linear", motion.linear_acceleration_m_s2[k], "angular",
                                                   yaw_acceleration(motion, k))},
                      {"effort", effort_json(motion, k, input.world.robot.geometry)}});
  return one_file(input, {{"header", header_json(0.0)}, {"points", std::move(points)}});
}

}  // namespace joulepath
