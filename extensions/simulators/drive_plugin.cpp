#include <algorithm>
#include <cctype>

#include "extensions/simulators/model_files.hpp"
#include "model/text_of_list.hpp"

namespace joulepath {
namespace {

struct LengthName {
  const char* name;
  std::optional<StatedLength> Mechanism::*field;
  double factor;
};
constexpr LengthName kLengthNames[] = {{"wheel_radius", &Mechanism::wheel_radius, 1.0},
                                       {"wheel_diameter", &Mechanism::wheel_radius, 0.5},
                                       {"wheelDiameter", &Mechanism::wheel_radius, 0.5},
                                       {"wheel_separation", &Mechanism::separation, 1.0},
                                       {"wheelSeparation", &Mechanism::separation, 1.0}};

struct LimitName {
  const char* name;
  const char* key;
  double factor;
};
constexpr LimitName kLimitNames[] = {{"max_linear_velocity", "limits.speed_m_s", 1.0},
                                     {"min_linear_velocity", "limits.reverse_speed_m_s", -1.0},
                                     {"max_linear_acceleration", "limits.acceleration_m_s2", 1.0},
                                     {"min_linear_acceleration", "limits.deceleration_m_s2", -1.0},
                                     {"max_angular_velocity", "limits.yaw_rate_rad_s", 1.0},
                                     {"max_angular_acceleration", "limits.yaw_acceleration_rad_s2", 1.0}};

bool is_drive(const XmlElement& plugin) {
  std::string called = plugin.attribute("filename").value_or("") + plugin.attribute("name").value_or("");
  std::erase_if(called, [](char c) { return c == '_' || c == '-'; });
  std::ranges::transform(called, called.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return called.find("diffdrive") != std::string::npos ||
         called.find("differentialdrive") != std::string::npos;
}

void add_joints(const XmlElement& plugin, const char* name, std::vector<std::string>& joints) {
  for (const XmlElement& joint : plugin.children(name))
    if (std::ranges::find(joints, joint.text()) == joints.end()) joints.push_back(joint.text());
}

}  // namespace

void read_drive_plugins(const XmlElement& root, Mechanism& mechanism) {
  for (const XmlElement& plugin : root.descendants("plugin")) {
    if (!is_drive(plugin)) continue;
    for (const char* name : {"left_joint", "leftJoint"}) add_joints(plugin, name, mechanism.left);
    for (const char* name : {"right_joint", "rightJoint"}) add_joints(plugin, name, mechanism.right);
    for (const auto& [name, field, factor] : kLengthNames)
      if (const auto value = plugin.number_in(name); value && *value > 0)
        mechanism.*field =
            StatedLength{factor * *value, plugin.find(name)->place() + ": " +
                                              (factor == 1.0 ? "" : "half of ") + name + " of the plugin"};
    for (const auto& [name, key, factor] : kLimitNames)
      if (const auto value = plugin.number_in(name); value && factor * *value > 0)
        mechanism.limits.push_back(
            {key, {factor * *value, plugin.find(name)->place() + ": " + name + " of the plugin"}});
  }
}

}  // namespace joulepath
