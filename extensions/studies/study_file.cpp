#include "extensions/studies/study_file.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "model/number_text.hpp"
#include "scenarios/document_kind.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "scenarios/text/schema_text.hpp"

namespace joulepath {

namespace embedded {
extern const std::string_view studies_schemas;
}

namespace {

constexpr const char* kGear = "motor.gear_ratio";

constexpr double kLeastStep = 1e-11;  // between levels, of a range's larger end

/// The levels of a list. Refuses a value that the list has already: its designs would be planned and counted
/// twice.
std::vector<std::string> levels_from(const Node& values) {
  std::vector<std::string> levels;
  std::set<std::string> texts;
  std::set<double> numbers;
  for (const Node& value : values.items()) {
    const auto number = value.value().quoted ? std::nullopt : parse_number(value.text());
    const bool is_new = number ? numbers.insert(*number).second : texts.insert(value.text()).second;
    if (!is_new) value.fail("each value once");
    levels.push_back(value.text());
  }
  return levels;
}

SweepParameter parameter_from(const std::string& name, const Node& node) {
  SweepParameter parameter{.name = name};
  if (const auto values = node.find("values")) {
    for (const char* key : {"to", "count", "scale"})
      if (node.has(key)) node[key].fail("this key together with from, not with values");
    parameter.levels = levels_from(*values);
    return parameter;
  }
  parameter.from = node["from"].number();
  parameter.to = node["to"].number();
  parameter.count = static_cast<std::size_t>(node.number_or("count", 5));
  parameter.logarithmic = node.text_or("scale", "linear") == "log";
  if (parameter.to <= parameter.from) node["to"].fail("a number > from");
  const double step = parameter.to / static_cast<double>(parameter.count) -
                      parameter.from / static_cast<double>(parameter.count);
  if (step < kLeastStep * std::max(std::abs(parameter.from), std::abs(parameter.to)))
    node["to"].fail("a number > from by more than rounding",
                    "levels differ by at least 1e-11 of the larger end");
  if (parameter.logarithmic && parameter.from <= 0) node["from"].fail("a number > 0 with scale: log");
  return parameter;
}

StudyTarget target_from(const Node& key) {
  const std::string& text = key.text();
  for (const auto& [prefix, in_robot] : {std::pair{"robot.", true}, {"mission.", false}})
    if (text.rfind(prefix, 0) == 0 && text != prefix)
      return {
          .in_robot = in_robot, .path = text.substr(std::string(prefix).size()), .named_by = NamedBy(key)};
  key.fail("robot.KEY or mission.KEY",
           text.rfind("limits.", 0) == 0 ? "limits are the robot's: robot." + text : "");
}

DesignTable designs_from(const Node& root, std::vector<SweepParameter> parameters) {
  const auto sampling = root.find("sampling");
  const bool hypercube = sampling && (*sampling)["method"].text() == "latin_hypercube";
  for (const auto& [name, parameter] : root["parameters"].entries())
    if (hypercube && parameter.has("count"))
      parameter["count"].fail("this key on a grid", "a hypercube has one value of the range per design");
  if (hypercube)
    return DesignTable::latin_hypercube(std::move(parameters),
                                        static_cast<std::size_t>((*sampling)["designs"].integer()),
                                        static_cast<std::uint64_t>(sampling->number_or("seed", 1)));
  if (sampling)
    for (const char* key : {"designs", "seed"})
      if (sampling->has(key)) (*sampling)[key].fail("this key with method: latin_hypercube");
  double designs = 1;
  for (const SweepParameter& parameter : parameters)
    designs *= static_cast<double>(parameter.is_range() ? parameter.count : parameter.levels.size());
  if (designs > static_cast<double>(DesignTable::kMost))
    root["parameters"].fail_found(number_text(designs) + " designs on the grid",
                                  "at most " + std::to_string(DesignTable::kMost),
                                  "sampling: {method: latin_hypercube, designs: 1000} draws fewer");
  return DesignTable::grid(std::move(parameters));
}

/// A name of a result or of a parameter.
void check_result_name(const Node& parent, const std::string& name, const DesignTable& designs,
                       bool parameters_too) {
  std::vector<std::string> names = sweep_results();
  if (parameters_too)
    for (const SweepParameter& parameter : designs.parameters()) names.push_back(parameter.name);
  if (std::ranges::find(names, name) != names.end()) return;
  std::string accepted;
  for (const std::string& one : names) accepted += (accepted.empty() ? "one of: " : ", ") + one;
  const std::string near = nearest_word(name, names);
  parent.fail_found(name, accepted, near.empty() ? "" : "did you mean " + near + "?");
}

void read_goals(const Node& root, Study& study) {
  if (const auto constraints = root.find("constraints"))
    for (const auto& [name, bounds] : constraints->entries()) {
      check_result_name(*constraints, name, study.designs, false);
      if (!bounds.has("min") && !bounds.has("max")) bounds.fail("min, max or both");
      const StudyConstraint& made = study.constraints.emplace_back(
          StudyConstraint{name, bounds.optional_number("min"), bounds.optional_number("max")});
      if (made.min && made.max && *made.min > *made.max) bounds["min"].fail("a number <= max");
    }
  if (const auto objectives = root.find("objectives"))
    for (const auto& [name, direction] : objectives->entries()) {
      check_result_name(*objectives, name, study.designs, true);
      for (const SweepParameter& parameter : study.designs.parameters())
        for (const std::string& level : parameter.levels)
          if (parameter.name == name && !parse_number(level))
            direction.fail_found(name + ", a parameter with the value " + level,
                                 "a result, or a parameter whose values are numbers");
      study.objectives.push_back({name, direction.text() == "maximize"});
    }
  if (study.objectives.empty()) study.objectives.push_back({"energy_J", false});
}

/// The keys and items of a path: `legs`, `[0]`, `payload_kg`.
std::vector<std::string> steps_of_key(const std::string& path) {
  std::vector<std::string> steps{""};
  for (const char c : path) {
    if ((c == '.' || c == '[') && !steps.back().empty()) steps.emplace_back();
    if (c != '.') steps.back() += c;
  }
  return steps;
}

/// True if two targets have a value in common: `legs[*].payload_kg` and `legs[0].payload_kg`.
bool overlap(const StudyTarget& a, const StudyTarget& b) {
  if (a.in_robot != b.in_robot) return false;
  const std::vector<std::string> one = steps_of_key(a.path), other = steps_of_key(b.path);
  for (std::size_t k = 0; k < std::min(one.size(), other.size()); ++k) {
    const bool items = one[k].front() == '[' && other[k].front() == '[';
    if (one[k] != other[k] && !(items && (one[k] == "[*]" || other[k] == "[*]"))) return false;
  }
  return true;
}

/// Refuses names that are other columns of sweep.csv, and a value that two parameters change.
void check_parameter(const std::string& name, const Node& node, const Study& study,
                     const std::vector<SweepParameter>& others) {
  if (name.empty()) node.fail_found("an empty name", "a name for the column of sweep.csv");
  for (const auto* columns : {&sweep_results(), &kColumnsBefore, &kColumnsAfter})
    if (std::ranges::find(*columns, name) != columns->end())
      node.fail_found("the name " + name, "a name that no other column of sweep.csv has");
  for (std::size_t p = 0; p < others.size(); ++p)
    if (overlap(study.targets[p], study.targets.back()))
      node["key"].fail("a value that no other parameter changes",
                       "the parameter " + others[p].name + " changes it, too");
}

/// `motor.gear_ratio` of `motor[0].gear_ratio`: a path without its items.
std::string without_items(const std::string& path) {
  std::string keys;
  bool inside = false;
  for (const char c : path) {
    inside = (inside || c == '[') && c != ']';
    if (!inside && c != ']') keys += c;
  }
  return keys;
}

/// The design's values of the robot or of the mission, with their paths.
std::vector<ValueChange> changes_of(const Study& study, const std::vector<std::string>& design, bool robot) {
  std::vector<ValueChange> changes;
  for (std::size_t p = 0; p < design.size(); ++p)
    if (study.targets[p].in_robot == robot)
      changes.push_back({study.targets[p].path, design[p], study.targets[p].named_by});
  return changes;
}

/// An error about a value from the study is reported at the study's parameter.
[[noreturn]] void throw_at_parameter(const ConfigError& error, const std::vector<ValueChange>& changes) {
  const ConfigError::Detail& detail = error.detail();
  for (const ValueChange& change : changes)
    if (without_items(change.path) == without_items(detail.key))
      throw ConfigError({change.named_by.mark, change.named_by.key, detail.found + " for " + detail.key,
                         detail.accepted, detail.hint});
  throw error;
}

}  // namespace

bool Study::changes_gear() const {
  return std::ranges::any_of(targets,
                             [](const StudyTarget& t) { return t.in_robot && t.path.rfind(kGear, 0) == 0; });
}

const std::vector<std::string>& sweep_results() {
  static const std::vector<std::string> names{"energy_J", "motion_energy_J", "duration_s", "distance_m",
                                              "battery_end_fraction"};
  return names;
}

Schema study_schema() {
  return schema_in(embedded::studies_schemas, "study", false,
                   {{"designs", integer({2, static_cast<double>(DesignTable::kMost)})}});
}

Schema sweep_schema() { return schema_in(embedded::studies_schemas, "sweep", true); }

Schema shard_schema() { return schema_in(embedded::studies_schemas, "shard", true); }

Study read_study(const std::string& file, const ReadOptions& options) {
  std::string text = read_text_file(file);
  Study study = study_from(Document::parse(text, file), options);
  study.text = std::move(text);
  return study;
}

Study study_from(const Document& document, const ReadOptions& options) {
  check_document(document, "study", study_schema());
  const Node root = document.root();
  Study study{.file = document.file(), .name = root.text_or("name", "")};
  const Node missions = root["missions"];
  for (const Node& mission :
       missions.kind() == Value::Kind::list ? missions.items() : std::vector<Node>{missions}) {
    study.missions.push_back(resolve_file(mission, options));
    study.missions_named_by.emplace_back(mission);
  }
  if (const auto robot = root.find("robot")) {
    study.robot_file = resolve_file(*robot, options);
    study.robot_named_by = NamedBy(*robot);
  }
  std::vector<SweepParameter> parameters;
  for (const auto& [name, node] : root["parameters"].entries()) {
    study.targets.push_back(target_from(node["key"]));
    check_parameter(name, node, study, parameters);
    parameters.push_back(parameter_from(name, node));
  }
  if (parameters.empty()) root["parameters"].fail("at least one parameter");
  study.designs = designs_from(root, std::move(parameters));
  read_goals(root, study);
  if (root.text_or("hold_friction", "wheel") == "motor") study.friction = FrictionHeld::motor;
  return study;
}

MissionRequest mission_of_design(const Study& study, const Document& mission,
                                 const std::vector<std::string>& design, const ReadOptions& options) {
  const std::vector<ValueChange> changes = changes_of(study, design, false);
  try {
    return mission_from(mission.with(changes), options);
  } catch (const ConfigError& error) {
    throw_at_parameter(error, changes);
  }
}

Robot robot_of_design(const Study& study, const Document& robot, const std::vector<std::string>& design) {
  const std::vector<ValueChange> changes = changes_of(study, design, true);
  Robot changed = [&] {
    try {
      return robot_from(robot.with(changes));
    } catch (const ConfigError& error) {
      throw_at_parameter(error, changes);
    }
  }();
  if (study.friction == FrictionHeld::wheel || !study.changes_gear()) return changed;
  const Robot base = robot_from(robot);
  // Torque at the wheel is n times that of the motor, speed at the motor n times that of the wheel.
  for (const Side side : kSides) {
    const double ratio = changed.motor[side].gear_ratio / base.motor[side].gear_ratio;
    changed.motor[side].friction_torque_Nm *= ratio;
    changed.motor[side].viscous_friction_Nm_s_rad *= ratio * ratio;
  }
  return changed;
}

}  // namespace joulepath
