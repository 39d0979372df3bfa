#include "scenarios/mission_files/motion_entry.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath {
namespace {

struct MotionKey {
  const char* name;
  std::optional<double> PrescribedMotion::*field;
  Range range;
};
constexpr MotionKey kMotionKeys[] = {
    {"acceleration_m_s2", &PrescribedMotion::acceleration_m_s2, kPositive},
    {"deceleration_m_s2", &PrescribedMotion::deceleration_m_s2, kPositive},
    {"speed_m_s", &PrescribedMotion::speed_m_s, kPositive},
    {"start_speed_m_s", &PrescribedMotion::start_speed_m_s, kNotNegative},
    {"ramp_s", &PrescribedMotion::ramp_s, kPositive},
    {"distance_m", &PrescribedMotion::distance_m, kPositive},
    {"duration_s", &PrescribedMotion::duration_s, kPositive},
    {"radius_m", &PrescribedMotion::radius_m, kPositive},
    {"angle_rad", &PrescribedMotion::angle_rad, kAny},
    {"yaw_rate_rad_s", &PrescribedMotion::yaw_rate_rad_s, kPositive},
    {"yaw_acceleration_rad_s2", &PrescribedMotion::yaw_acceleration_rad_s2, kPositive},
};

MotionProfile profile_named(const std::string& name) {
  const auto found = std::find(kMotionProfileNames.begin(), kMotionProfileNames.end(), name);
  return static_cast<MotionProfile>(found - kMotionProfileNames.begin());
}

/// The keys that a profile requires; `|` separates keys of which one is enough.
std::vector<std::vector<std::string>> needs(MotionProfile profile) {
  switch (profile) {
    case MotionProfile::constant_ramp:
      return {{"acceleration_m_s2"}, {"ramp_s", "speed_m_s"}, {"distance_m", "bezier_m"}};
    case MotionProfile::constant_speed:
      return {{"speed_m_s"}, {"distance_m", "duration_s", "bezier_m"}};
    case MotionProfile::trapezoid:
      return {{"acceleration_m_s2"}, {"speed_m_s"}, {"distance_m", "bezier_m"}};
    case MotionProfile::stand:
      return {{"duration_s"}};
    case MotionProfile::spin:
      return {{"yaw_rate_rad_s"}, {"angle_rad", "duration_s"}};
    case MotionProfile::arc:
      return {{"radius_m"}, {"angle_rad"}, {"speed_m_s"}};
    case MotionProfile::coast:
      return {{"speed_m_s"}};
  }
  return {};
}

}  // namespace

Schema bezier_schema() { return list(list(list(number(), 2, 2), 4, 4), 1); }

std::vector<BezierPoints> read_bezier(const Node& node) {
  std::vector<BezierPoints> curves;
  for (const auto& item : node.items()) {
    BezierPoints points;
    const auto corners = item.items();
    for (std::size_t i = 0; i < 4; ++i)
      points[i] = {corners[i].items()[0].number(), corners[i].items()[1].number()};
    const bool point =
        std::all_of(points.begin(), points.end(), [&](const auto& p) { return p == points[0]; });
    if (point) item.fail_found("a curve without length", "four control points that are not all the same");
    if (!curves.empty()) {
      const auto& end = curves.back()[3];
      if (std::hypot(end[0] - points[0][0], end[1] - points[0][1]) > 1e-6)
        corners[0].fail("the point where the curve before ends", "the curves of one chain join end to start");
    }
    curves.push_back(points);
  }
  return curves;
}

Schema motion_schema() {
  std::vector<std::string> names(kMotionProfileNames.begin(), kMotionProfileNames.end());
  std::vector<Schema::Key> keys{required("profile", choice(names), "prescribed, not optimized")};
  for (const auto& key : kMotionKeys) keys.push_back(optional(key.name, number(key.range)));
  keys.push_back(optional("repeat", integer({1, 10000}), "number of repetitions, one after the other"));
  keys.push_back(optional("direction", choice({"forward", "reverse"})));
  keys.push_back(
      optional("bezier_m", bezier_schema(), "the curve that is followed, in the robot's frame at the start"));
  return map(std::move(keys));
}

PrescribedMotion read_motion(const Node& node) {
  PrescribedMotion motion;
  motion.profile = profile_named(node["profile"].text());
  for (const auto& group : needs(motion.profile)) {
    std::string words;
    for (const auto& key : group) words += (words.empty() ? "" : " or ") + key;
    if (std::none_of(group.begin(), group.end(), [&](const auto& key) { return node.has(key); }))
      node.fail(words, "a motion of profile " + node["profile"].text() + " needs it");
  }
  for (const auto& key : kMotionKeys) motion.*key.field = node.optional_number(key.name);
  if (motion.angle_rad && *motion.angle_rad == 0.0) node["angle_rad"].fail("an angle other than 0");
  if (const auto repeat = node.find("repeat")) motion.repeat = static_cast<int>(repeat->integer());
  motion.reverse = node.text_or("direction", "forward") == "reverse";
  if (const auto curve = node.find("bezier_m")) motion.bezier_m = read_bezier(*curve);
  return motion;
}

}  // namespace joulepath
