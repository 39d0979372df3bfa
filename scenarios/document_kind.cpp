#include "scenarios/document_kind.hpp"

#include <algorithm>

#include "scenarios/registry.hpp"
// Design: docs/decisions/0600-input-files.md
namespace joulepath {
namespace {

const std::string kRosParameters = "ROS parameters";

/// Of a line `joulepath/<kind>/<version>`; empty for others.
std::pair<std::string, std::string> kind_and_version(const std::string& line) {
  const std::string prefix = "joulepath/";
  const auto slash = line.rfind('/');
  if (line.compare(0, prefix.size(), prefix) != 0 || slash == std::string::npos || slash < prefix.size())
    return {};
  return {line.substr(prefix.size(), slash - prefix.size()), line.substr(slash + 1)};
}

std::string kind_by_keys(const Node& root) {
  for (const FileReader& reader : registry().files)
    if (!reader.key.empty() && root.has(reader.key)) return reader.kind;
  for (const auto& [key, kind] : {std::pair{"image", "map"},
                                  {"resolution", "map"},
                                  {"runs", "dataset"},
                                  {"legs", "mission"},
                                  {"visit", "mission"},
                                  {"bezier_m", "path"},
                                  {"waypoints", "path"},
                                  {"poses", "path"},
                                  {"points", "path"},
                                  {"geometry", "robot"},
                                  {"motor_sheet", "motor_sheet"},
                                  {"motor", "robot"},
                                  {"inertia", "robot"}})
    if (root.has(key)) return kind;
  for (const MissionKey& known : registry().mission_keys)
    if (root.has(known.key)) return "mission";
  return "";
}

constexpr int kDeepestNamespace = 3;

/// Namespaces may stand around a node.
bool has_ros_parameters(const Node& node, int depth) {
  if (node.kind() != Value::Kind::map) return false;
  const auto entries = node.entries();
  return std::any_of(entries.begin(), entries.end(), [&](const auto& entry) {
    return entry.first == "ros__parameters" || (depth > 0 && has_ros_parameters(entry.second, depth - 1));
  });
}

/// Formats of other programs, which have no schema line.
bool is_foreign(const std::string& kind) {
  const auto is_named = [&](const auto& list, auto name) {
    return std::any_of(list.begin(), list.end(), [&](const auto& item) { return item.*name == kind; });
  };
  return kind == "map" || kind == kRosParameters ||
         (is_named(registry().files, &FileReader::kind) && !is_named(registry().kinds, &FileKind::name));
}

}  // namespace

std::string inferred_kind(const Node& root) {
  if (root.kind() != Value::Kind::map) return "";
  if (const auto line = root.find("schema"); line && line->kind() == Value::Kind::scalar)
    return kind_and_version(line->text()).first;
  if (std::string kind = kind_by_keys(root); !kind.empty()) return kind;
  return has_ros_parameters(root, kDeepestNamespace) ? kRosParameters : "";
}

void check_document(const Document& document, const std::string& kind, const Schema& schema) {
  const Node root = document.root();
  if (root.kind() != Value::Kind::map)
    root.fail(root.kind() == Value::Kind::null ? "a file of kind " + kind + "; this one is empty"
                                               : accepted_by(schema));
  if (const auto line = root.find("schema")) {
    const std::string expected = "joulepath/" + kind + "/1";
    const auto [found_kind, version] = kind_and_version(line->text());
    if (found_kind == kind && version != "1")
      line->fail(expected, "this program reads version 1 of this kind of file");
    if (found_kind != kind)
      line->fail(expected, found_kind.empty() ? ""
                                              : "this is a file of kind " + found_kind +
                                                    ", where one of kind " + kind + " is needed");
  } else if (const std::string found = inferred_kind(root); is_foreign(found) && found != kind) {
    root.fail_found("a file of kind " + found, "one of kind " + kind);
  }
  check_value(root, schema);
}

}  // namespace joulepath
