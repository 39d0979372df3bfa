#include "scenarios/text/schema.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "model/text_of_list.hpp"
// Design: docs/decisions/0600-input-files.md
namespace joulepath {
namespace {

std::string bound_text(double value) {
  std::ostringstream stream;
  stream << value;
  return stream.str();
}

std::string range_text(const Range& range) {
  const bool low = range.min > -std::numeric_limits<double>::infinity();
  const bool high = range.max < std::numeric_limits<double>::infinity();
  if (low && high)
    return (range.above_min ? " > " + bound_text(range.min) + " and <= "
                            : " from " + bound_text(range.min) + " to ") +
           bound_text(range.max);
  if (low) return (range.above_min ? " > " : " >= ") + bound_text(range.min);
  if (high) return " <= " + bound_text(range.max);
  return "";
}

Value::Kind shape_of(const Schema& schema) {
  switch (schema.kind) {
    case Schema::Kind::list:
      return Value::Kind::list;
    case Schema::Kind::map:
    case Schema::Kind::dictionary:
      return Value::Kind::map;
    default:
      return Value::Kind::scalar;
  }
}

void check_number(const Node& node, const Schema& schema) {
  const double value =
      schema.kind == Schema::Kind::integer ? static_cast<double>(node.integer()) : node.number();
  const Range& range = schema.range;
  if (value < range.min || value > range.max || (range.above_min && value <= range.min))
    node.fail(accepted_by(schema), range.why == nullptr ? "" : range.why);
  if (value != 0.0 && std::abs(value) < range.least_size)
    node.fail("0, or a size of at least " + bound_text(range.least_size),
              range.why == nullptr ? "" : range.why);
}

void check_choice(const Node& node, const Schema& schema) {
  if (node.kind() == Value::Kind::scalar &&
      std::find(schema.choices.begin(), schema.choices.end(), node.value().text) != schema.choices.end())
    return;
  const std::string near =
      node.kind() == Value::Kind::scalar ? nearest_word(node.value().text, schema.choices) : "";
  node.fail(accepted_by(schema), near.empty() ? "" : "did you mean " + near + "?");
}

void check_list(const Node& node, const Schema& schema) {
  if (node.kind() != Value::Kind::list) node.fail(accepted_by(schema));
  const auto items = node.items();
  if (items.size() < schema.min_items || items.size() > schema.max_items) node.fail(accepted_by(schema));
  for (const auto& item : items) check_value(item, schema.parts.front());
}

const Schema::Key* key_named(const Schema& schema, const std::string& name) {
  for (const auto& key : schema.keys)
    if (key.name == name) return &key;
  return nullptr;
}

/// A number in the place of a key is what a decimal comma leaves within braces: {a: 10,0, b: 1}.
std::string unknown_hint(const std::string& key, const std::vector<std::string>& known) {
  if (parse_number(key)) return "a comma separates keys; the decimal sign is a point";
  const std::string near = nearest_word(key, known);
  return near.empty() ? "" : "did you mean " + near + "?";
}

void check_unknown_keys(const Node& node, const Schema& schema) {
  for (const auto& entry : node.value().entries) {
    if (key_named(schema, entry.key)) continue;
    std::vector<std::string> names, missing;
    for (const auto& key : schema.keys) {
      names.push_back(key.name);
      if (!node.has(key.name)) missing.push_back(key.name);
    }
    throw ConfigError({{node.mark().file, entry.line, entry.column},
                       node.path_of(entry.key),
                       "an unknown key",
                       text_of_list(names),
                       unknown_hint(entry.key, missing.empty() ? names : missing)});
  }
}

void check_groups(const Node& node, const Schema& schema) {
  for (const auto& group : schema.exactly_one) {
    std::vector<std::string> present;
    for (const auto& name : group)
      if (node.has(name)) present.push_back(name);
    if (present.size() != 1)
      node.fail_found(
          present.empty() ? "none of " + text_of_list(group) : text_of_list(present) + " together",
          "exactly one of: " + text_of_list(group));
  }
}

/// The hint for a required key that is absent: of a map that accepts further keys, with one that resembles
/// it.
std::string required_hint(const Node& node, const Schema& schema, const std::string& name) {
  std::vector<std::string> others;
  for (const auto& entry : node.value().entries)
    if (!key_named(schema, entry.key)) others.push_back(entry.key);
  const std::string near = nearest_word(name, others);
  return "this key is required" + (near.empty() ? "" : "; " + near + " is not read");
}

void check_map(const Node& node, const Schema& schema) {
  if (node.kind() != Value::Kind::map) node.fail(accepted_by(schema));
  if (!schema.open) check_unknown_keys(node, schema);
  for (const auto& key : schema.keys) {
    const bool present = std::any_of(node.value().entries.begin(), node.value().entries.end(),
                                     [&](const auto& entry) { return entry.key == key.name; });
    if (key.required && !present)
      throw ConfigError({node.mark(), node.path_of(key.name), "nothing", accepted_by(key.schema),
                         required_hint(node, schema, key.name)});
  }
  check_groups(node, schema);
  if (node.value().entries.size() < schema.min_items || node.value().entries.size() > schema.max_items)
    node.fail(schema.max_items == 1 ? "a map with one key" : accepted_by(schema));
  for (const auto& [name, child] : node.entries())
    if (const auto* key = key_named(schema, name)) check_value(child, key->schema);
}

/// Alternatives differ by their shape; where two have the same shape, the error is that of the last one.
void check_any_of(const Node& node, const Schema& schema) {
  std::vector<const Schema*> fitting;
  for (const auto& alternative : schema.parts)
    if (shape_of(alternative) == node.kind()) fitting.push_back(&alternative);
  if (fitting.empty()) node.fail(accepted_by(schema));
  for (std::size_t i = 0; i + 1 < fitting.size(); ++i) try {
      return check_value(node, *fitting[i]);
    } catch (const ConfigError&) {
    }
  check_value(node, *fitting.back());
}

Schema of_kind(Schema::Kind kind) {
  Schema schema;
  schema.kind = kind;
  return schema;
}

}  // namespace

Schema Schema::with_exactly_one(std::vector<std::string> group) && {
  exactly_one.push_back(std::move(group));
  return std::move(*this);
}

Schema number(Range range) {
  Schema schema = of_kind(Schema::Kind::number);
  schema.range = range;
  return schema;
}
Schema integer(Range range) {
  Schema schema = of_kind(Schema::Kind::integer);
  schema.range = range;
  return schema;
}
Schema boolean() { return of_kind(Schema::Kind::boolean); }
Schema text() { return of_kind(Schema::Kind::text); }
Schema choice(std::vector<std::string> words) {
  Schema schema = of_kind(Schema::Kind::choice);
  schema.choices = std::move(words);
  return schema;
}
Schema list(Schema item, std::size_t min_items, std::size_t max_items) {
  Schema schema = of_kind(Schema::Kind::list);
  schema.parts.push_back(std::move(item));
  schema.min_items = min_items;
  schema.max_items = max_items;
  return schema;
}
Schema map(std::vector<Schema::Key> keys) {
  Schema schema = of_kind(Schema::Kind::map);
  schema.keys = std::move(keys);
  return schema;
}
Schema dictionary(Schema item) {
  Schema schema = of_kind(Schema::Kind::dictionary);
  schema.parts.push_back(std::move(item));
  return schema;
}
Schema any_of(std::vector<Schema> alternatives) {
  Schema schema = of_kind(Schema::Kind::any_of);
  schema.parts = std::move(alternatives);
  return schema;
}
Schema sided(const Schema& value) {
  return any_of({value, map({required("left", value), required("right", value)})});
}
Schema open(Schema map) {
  map.open = true;
  return map;
}
Schema nullable(Schema value) {
  value.nullable = true;
  return value;
}
Schema::Key required(std::string name, Schema schema, std::string says) {
  return {std::move(name), std::move(schema), std::move(says), true};
}
Schema::Key optional(std::string name, Schema schema, std::string says) {
  return {std::move(name), std::move(schema), std::move(says), false};
}

std::string accepted_by(const Schema& schema) {
  switch (schema.kind) {
    case Schema::Kind::number:
      return "a number" + range_text(schema.range);
    case Schema::Kind::integer:
      return "a whole number" + range_text(schema.range);
    case Schema::Kind::boolean:
      return "true or false";
    case Schema::Kind::text:
      return "a text";
    case Schema::Kind::choice:
      return "one of: " + text_of_list(schema.choices);
    case Schema::Kind::dictionary:
      return "a map whose values are each " + accepted_by(schema.parts.front());
    case Schema::Kind::list: {
      const bool exact = schema.min_items == schema.max_items;
      const std::string count = exact                  ? " of " + std::to_string(schema.min_items)
                                : schema.min_items > 0 ? " of at least " + std::to_string(schema.min_items)
                                                       : "";
      const std::string item = accepted_by(schema.parts.front());
      return "a list" + count + ", each " + item;
    }
    case Schema::Kind::map: {
      if (schema.keys.size() > 12) return "a map (key: value)";
      std::vector<std::string> names;
      for (const auto& key : schema.keys) names.push_back(key.name);
      return "a map with keys " + text_of_list(names);
    }
    case Schema::Kind::any_of:
      break;
  }
  std::string text;
  for (const auto& part : schema.parts) text += (text.empty() ? "" : ", or ") + accepted_by(part);
  return text;
}

void check_value(const Node& node, const Schema& schema) {
  if (node.kind() == Value::Kind::null && schema.nullable) return;
  if (node.kind() == Value::Kind::null)
    node.fail(accepted_by(schema), "write a value, or omit the key if it is optional");
  switch (schema.kind) {
    case Schema::Kind::number:
    case Schema::Kind::integer:
      return check_number(node, schema);
    case Schema::Kind::boolean:
      return static_cast<void>(node.boolean());
    case Schema::Kind::text:
      return static_cast<void>(node.text());
    case Schema::Kind::choice:
      return check_choice(node, schema);
    case Schema::Kind::list:
      return check_list(node, schema);
    case Schema::Kind::map:
      return check_map(node, schema);
    case Schema::Kind::any_of:
      return check_any_of(node, schema);
    case Schema::Kind::dictionary:
      if (node.kind() != Value::Kind::map) node.fail(accepted_by(schema));
      for (const auto& [name, child] : node.entries()) check_value(child, schema.parts.front());
  }
}

}  // namespace joulepath
