#include <algorithm>

#include "scenarios/text/document.hpp"

namespace joulepath {
namespace {

/// A step of a path: a key of a map, an item of a list, or every item.
struct Step {
  std::string key{};
  std::optional<std::size_t> item{};
  bool every{};
};

[[noreturn]] void refuse(const NamedBy& named_by, std::string found, std::string accepted,
                         std::string hint = {}) {
  throw ConfigError({named_by.mark, named_by.key, std::move(found), std::move(accepted), std::move(hint)});
}

Step bracket_step(const std::string& inside, const std::string& path, const NamedBy& named_by) {
  if (inside == "*") return {.every = true};
  const bool digits =
      !inside.empty() && inside.size() < 9 && inside.find_first_not_of("0123456789") == std::string::npos;
  if (!digits) refuse(named_by, path, "an item as [0] or [*]");
  return {.item = std::stoul(inside)};
}

std::vector<Step> steps_of(const std::string& path, const NamedBy& named_by) {
  std::vector<Step> steps;
  for (std::size_t at = 0; at < path.size();) {
    if (path[at] == '[') {
      const std::size_t end = path.find(']', at);
      if (end == std::string::npos) refuse(named_by, path, "a closing ]");
      steps.push_back(bracket_step(path.substr(at + 1, end - at - 1), path, named_by));
      at = end + 1;
    } else {
      if (path[at] == '.' && at > 0) ++at;
      const std::size_t end = std::min(path.find_first_of(".[", at), path.size());
      if (end == at) refuse(named_by, path, "keys with a point between them: motor.gear_ratio");
      steps.push_back({.key = path.substr(at, end - at)});
      at = end;
    }
  }
  return steps;
}

/// The values of one step.
std::vector<Value*> below(Value& value, const Step& step, const std::string& path, const NamedBy& named_by) {
  std::vector<Value*> found;
  if (step.every || step.item) {
    for (Value& item : value.items) found.push_back(&item);
    for (Value::Entry& entry : value.entries) found.push_back(&entry.value);
    if (step.every && found.empty()) refuse(named_by, path, "a path whose [*] stands for a list with items");
    if (step.every) return found;
    if (value.kind != Value::Kind::list || *step.item >= found.size())
      refuse(named_by, path,
             "an item that exists: there are " + std::to_string(value.items.size()) + ", counted from 0");
    return {found[*step.item]};
  }
  if (value.kind == Value::Kind::scalar || value.kind == Value::Kind::list)
    refuse(named_by, path, "a path that leads to a value", "there is no map that could hold " + step.key);
  value.kind = Value::Kind::map;
  for (Value::Entry& entry : value.entries)
    if (entry.key == step.key) return {&entry.value};
  value.entries.push_back({.key = step.key, .line = value.line, .column = value.column, .value = {}});
  Value& added = value.entries.back().value;
  added.line = value.line;
  added.column = value.column;
  return {&added};
}

}  // namespace

Document Document::with(const std::vector<ValueChange>& changes) const {
  Value root = *root_;
  for (const ValueChange& change : changes) {
    std::vector<Value*> places{&root};
    for (const Step& step : steps_of(change.path, change.named_by)) {
      std::vector<Value*> next;
      for (Value* place : places)
        for (Value* found : below(*place, step, change.path, change.named_by)) next.push_back(found);
      places = std::move(next);
    }
    for (Value* place : places) {
      Value value{.kind = Value::Kind::scalar, .text = change.text, .items = {}, .entries = {}};
      value.line = place->line;
      value.column = place->column;
      *place = std::move(value);
    }
  }
  Document changed;
  changed.file_ = std::make_unique<const std::string>(*file_);
  changed.root_ = std::make_unique<const Value>(std::move(root));
  changed.style_ = style_;
  return changed;
}

}  // namespace joulepath
