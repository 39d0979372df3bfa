#include "scenarios/robot_files/robot_draft.hpp"

#include <algorithm>
#include <cmath>

#include "model/printable.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "scenarios/text/quoted.hpp"
#include "scenarios/text/significant.hpp"

namespace joulepath {
namespace {

constexpr double kSameValue = 1e-3;  ///< relative: sides or sources that differ by less agree

/// In one line, so that nothing in it ends the comment.
std::string comment(const std::string& text) { return "  # " + printable(text) + "\n"; }

const DraftValue* value_of(const RobotDraft& draft, const std::string& key) {
  const auto found = std::ranges::find(draft.values, key, &DraftValue::key);
  return found == draft.values.end() ? nullptr : &*found;
}

/// Whether two values are of one thing: a robot has each effect once, and one footprint, a disc or a polygon.
bool says_the_same(const DraftValue& a, const DraftValue& b) {
  if (a.key == "effects" && b.key == "effects")
    return a.text.substr(0, a.text.find(':')) == b.text.substr(0, b.text.find(':'));
  return a.key == b.key || (a.key.starts_with("footprint.") && b.key.starts_with("footprint."));
}

std::string line_of(const RobotDraft& draft, const Schema::Key& key, const std::string& dotted) {
  const std::string indent = dotted == key.name ? "" : "  ";
  if (const DraftValue* value = value_of(draft, dotted))
    return indent + key.name + ": " + value->text + comment(value->origin);
  if (dotted == "power.standby_W")
    return indent + "# not stated: " + dotted +
           " (electronics and computer, often the largest part of a mission's energy)\n";
  if (!key.required) return "";
  return indent + "# missing: " + dotted + (key.says.empty() ? "" : " (" + key.says + ")") + "\n";
}

std::string lines_of(const RobotDraft& draft, const Schema::Key& section) {
  std::string lines;
  bool empty = true;
  for (const Schema::Key& key : section.schema.keys) {
    const std::string dotted = section.name + "." + key.name;
    lines += line_of(draft, key, dotted);
    empty = empty && value_of(draft, dotted) == nullptr;
  }
  return (empty ? "" : section.name + ":\n") + lines;
}

std::string effects(const RobotDraft& draft) {
  std::string lines;
  for (const DraftValue& value : draft.values)
    if (value.key == "effects") lines += "  - " + value.text + comment(value.origin);
  return lines.empty() ? "" : "effects:\n" + lines;
}

}  // namespace

void RobotDraft::state(const std::string& key, double value, const std::string& origin) {
  values.push_back({key, significant_text(value), origin});
}

void RobotDraft::state(const std::string& key, double left, double right, const std::string& origin) {
  if (std::abs(left - right) <= kSameValue * std::abs(left)) return state(key, 0.5 * (left + right), origin);
  values.push_back(
      {key, "{left: " + significant_text(left) + ", right: " + significant_text(right) + "}", origin});
}

void add_draft(RobotDraft& draft, const RobotDraft& more) {
  if (draft.name.empty()) draft.name = more.name;
  draft.notes.insert(draft.notes.end(), more.notes.begin(), more.notes.end());
  for (const DraftValue& value : more.values) {
    const auto known = std::ranges::find_if(
        draft.values, [&](const DraftValue& other) { return says_the_same(other, value); });
    if (known == draft.values.end())
      draft.values.push_back(value);
    else if (known->text != value.text)
      known->origin += "; not used: " + value.text + " of " + value.origin;
  }
}

std::string draft_text(const RobotDraft& draft) {
  std::string text =
      "schema: joulepath/robot/1\n# Beside each value: where it comes from. Lines \"# missing\" name "
      "required "
      "values that no source states:\n# docs/your_robot.md says where to find them; joulepath check lists "
      "them.\n";
  for (const std::string& note : draft.notes) text += "# note: " + printable(note) + "\n";
  text += "name: " + quoted(draft.name) + "\n";
  for (const Schema::Key& key : robot_schema().keys) {
    if (key.name == "schema" || key.name == "name") continue;
    text += key.name == "effects"                  ? effects(draft)
            : key.schema.kind == Schema::Kind::map ? lines_of(draft, key)
                                                   : line_of(draft, key, key.name);
  }
  return text;
}

std::vector<std::string> missing_in(const RobotDraft& draft) {
  std::vector<std::string> missing;
  for (const std::string& key : required_robot_keys())
    if (value_of(draft, key) == nullptr) missing.push_back(key);
  return missing;
}

}  // namespace joulepath
