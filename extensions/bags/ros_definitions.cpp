#include "extensions/bags/ros_definitions.hpp"

#include <map>
#include <set>
#include <sstream>
#include <string_view>
#include <vector>

// Names and types of fields are those of the interfaces of ROS 2 (common_interfaces, geometry2).
namespace joulepath {

namespace embedded {
extern const std::string_view ros_definitions;
}

namespace {

/// The types of extensions/bags/ros_definitions.msg: a line `MSG: name`, then its fields.
const std::map<std::string, std::string>& definitions() {
  static const std::map<std::string, std::string> known = [] {
    std::map<std::string, std::string> made;
    std::istringstream lines{std::string(embedded::ros_definitions)};
    std::string name;
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with("MSG: "))
        name = line.substr(5);
      else
        made[name] += line + "\n";
    return made;
  }();
  return known;
}

std::string short_type(const std::string& type) {
  const auto first = type.find('/'), last = type.rfind('/');
  return first == std::string::npos ? type : type.substr(0, first) + type.substr(last);
}

}  // namespace

std::string ros_definition(const std::string& type) {
  std::string text;
  std::vector<std::string> open{short_type(type)};
  std::set<std::string> seen{open.front()};
  while (!open.empty()) {
    const std::string name = open.back();
    open.pop_back();
    const auto found = definitions().find(name);
    if (found == definitions().end()) return {};
    if (!text.empty()) text += "================\nMSG: " + name + "\n";
    text += found->second;
    std::istringstream lines{found->second};
    for (std::string field, rest; lines >> field && std::getline(lines, rest);) {
      field = field.substr(0, field.find('['));
      if (field.find('/') != std::string::npos && seen.insert(field).second) open.push_back(field);
    }
  }
  return text;
}

}  // namespace joulepath
