#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "scenarios/robot_files/robot_file.hpp"
#include "scenarios/text/json_value.hpp"
#include "scenarios/text/significant.hpp"
#include "scenarios/text/text_edit.hpp"

namespace joulepath {
namespace {

using RobotJson = nlohmann::ordered_json;

RobotJson values_of(const std::string& text) {
  return json_of(Document::parse(text, "robot.yaml").root().value());
}

RobotJson rounded(RobotJson value) {
  if (value.is_number_float()) return six_digits(value);
  if (value.is_structured())
    for (RobotJson& item : value) item = rounded(item);
  return value;
}

/// The file's own values with what differs between the two robots.
RobotJson changed(const RobotJson& own, const RobotJson& before, const RobotJson& after) {
  if (before == after) return own;
  if (!own.is_object() || !before.is_object() || !after.is_object()) return rounded(after);
  RobotJson result = own;
  for (const auto& [key, value] : after.items()) {
    if (before.contains(key) && before[key] == value) continue;
    const bool is_within = own.contains(key) && before.contains(key);
    result[key] = is_within ? changed(own[key], before[key], value) : rounded(value);
  }
  for (const auto& [key, value] : before.items())
    if (!after.contains(key)) result.erase(key);
  return result;
}

/// Whether values agree to the digits that are written.
bool agree(const RobotJson& a, const RobotJson& b) {
  if (a.is_number() && b.is_number()) {
    const double x = a, y = b;
    return std::abs(x - y) <= 1e-5 * std::max(std::abs(x), std::abs(y));
  }
  if (!a.is_structured() || a.type() != b.type()) return a == b;
  if (a.size() != b.size()) return false;
  if (a.is_array()) return std::equal(a.begin(), a.end(), b.begin(), agree);
  return std::all_of(a.items().begin(), a.items().end(), [&](const auto& entry) {
    return b.contains(entry.key()) && agree(entry.value(), b[entry.key()]);
  });
}

}  // namespace

std::string robot_text_like(const std::string& file, const Robot& robot) {
  const std::string whole = robot_text(robot);
  if (file.empty()) return whole;
  try {
    const std::string text = read_text_file(file);
    const auto as_written = [&](const std::string& of) {
      return values_of(robot_text(robot_from(Document::parse(of, file))));
    };
    const std::string edited =
        with_values(text, file, changed(values_of(text), as_written(text), values_of(whole)));
    if (agree(as_written(edited), values_of(whole))) return edited;
  } catch (const ConfigError&) {  // a file of another format, or a notation that cannot be edited in place
  }
  return whole;
}

}  // namespace joulepath
