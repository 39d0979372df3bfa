#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "scenarios/document_kind.hpp"
#include "scenarios/file_kinds.hpp"
#include "scenarios/registry.hpp"
#include "scenarios/text/schema.hpp"
#include "tests/support/locations.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::json;

const std::string kData = JOULEPATH_SOURCE_DIR "/tests/data/";

/// A document as an editor's YAML reader passes it to a JSON Schema validator.
Json editor_json(const Value& value) {
  if (value.kind == Value::Kind::list) {
    Json list = Json::array();
    for (const auto& item : value.items) list.push_back(editor_json(item));
    return list;
  }
  if (value.kind == Value::Kind::map) {
    Json map = Json::object();
    for (const auto& entry : value.entries) map[entry.key] = editor_json(entry.value);
    return map;
  }
  if (value.kind == Value::Kind::null) return nullptr;
  if (value.quoted) return value.text;
  if (value.text == "true" || value.text == "false") return value.text == "true";
  if (const auto number = parse_number(value.text)) return *number;
  return value.text;
}

/// The part of JSON Schema that the program writes; an unknown keyword fails the test.
bool valid(const Json& value, const Json& schema) {
  const auto number = [&] { return value.is_number() ? value.get<double>() : 0.0; };
  for (const auto& [key, rule] : schema.items()) {
    if (key == "$schema" || key == "$id" || key == "title" || key == "description" || key == "properties" ||
        key == "additionalProperties")
      continue;
    if (key == "type") {
      const std::string type = rule;
      const bool whole = value.is_number() && number() == std::floor(number());
      if (type == "object"    ? !value.is_object()
          : type == "array"   ? !value.is_array()
          : type == "string"  ? !value.is_string()
          : type == "null"    ? !value.is_null()
          : type == "boolean" ? !value.is_boolean()
          : type == "integer" ? !whole
                              : !value.is_number())
        return false;
    } else if (key == "enum") {
      if (std::find(rule.begin(), rule.end(), value) == rule.end()) return false;
    } else if (key == "minimum") {
      if (number() < rule.get<double>()) return false;
    } else if (key == "maximum") {
      if (number() > rule.get<double>()) return false;
    } else if (key == "exclusiveMinimum") {
      if (number() <= rule.get<double>()) return false;
    } else if (key == "minItems" || key == "minProperties") {
      if (value.size() < rule.get<std::size_t>()) return false;
    } else if (key == "maxItems" || key == "maxProperties") {
      if (value.size() > rule.get<std::size_t>()) return false;
    } else if (key == "required") {
      for (const auto& name : rule)
        if (!value.contains(name.get<std::string>())) return false;
    } else if (key == "items") {
      for (const auto& item : value)
        if (!valid(item, rule)) return false;
    } else if (key == "anyOf" || key == "oneOf" || key == "allOf") {
      const auto count = static_cast<std::size_t>(
          std::count_if(rule.begin(), rule.end(), [&](const Json& part) { return valid(value, part); }));
      if (key == "anyOf" ? count == 0 : key == "oneOf" ? count != 1 : count != rule.size()) return false;
    } else {
      ADD_FAILURE() << "the test does not know the keyword " << key;
    }
  }
  if (!schema.contains("additionalProperties") || !value.is_object()) return true;
  const Json properties = schema.value("properties", Json::object());
  for (const auto& [name, child] : value.items()) {
    const Json& rule = properties.contains(name) ? properties[name] : schema["additionalProperties"];
    if (rule.is_boolean() ? !rule.get<bool>() : !valid(child, rule)) return false;
  }
  return true;
}

const FileKind* kind_of(const Document& document) {
  for (const auto& kind : file_kinds())
    if (document.root().kind() == Value::Kind::map && document.root().has("schema") &&
        document.root()["schema"].value().text == "joulepath/" + kind.name + "/1")
      return &kind;
  return nullptr;
}

TEST(JsonSchema, EveryKindIsAValidJsonObjectWithItsId) {
  const std::set<std::string> results{"plan",       "diagnosis", "after", "sweep", "shard",
                                      "controller", "edges",     "loss",  "drift", "fleet_schedule"};
  for (const auto& kind : file_kinds()) {
    const Json schema = Json::parse(json_schema(kind));
    EXPECT_EQ(schema["$id"], "joulepath/" + kind.name + "/1");
    EXPECT_EQ(schema["type"], "object");
    EXPECT_EQ(schema["additionalProperties"].get<bool>(), results.contains(kind.name) || kind.name == "map")
        << "results may grow, inputs may not; Nav2's maps may have keys that Nav2 does not read";
  }
}

TEST(JsonSchema, AgreesWithTheReadersOnGoodAndBrokenFiles) {
  std::set<std::string> kinds_accepted, kinds_refused;
  for (const auto& folder : {kData, std::string(JOULEPATH_SOURCE_DIR "/scenarios/")})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.path().extension() != ".yaml" && entry.path().extension() != ".json") continue;
      std::optional<Document> document;
      try {
        document = Document::load(entry.path().string());
      } catch (const ConfigError&) {
        continue;  // not YAML at all
      }
      const FileKind* kind = kind_of(*document);
      if (!kind) continue;
      bool accepted = true;
      try {
        check_document(*document, kind->name, kind->schema());
      } catch (const ConfigError&) {
        accepted = false;
      }
      EXPECT_EQ(valid(editor_json(document->root().value()), Json::parse(json_schema(*kind))), accepted)
          << entry.path();
      (accepted ? kinds_accepted : kinds_refused).insert(kind->name);
    }
  for (const char* kind : {"robot", "mission", "path", "dataset", "fleet", "plan", "diagnosis"}) {
    if (!absent_extension("kind", kind).empty()) continue;
    EXPECT_TRUE(kinds_accepted.contains(kind)) << kind;
    EXPECT_TRUE(kinds_refused.contains(kind)) << kind;
  }
}

}  // namespace
}  // namespace joulepath
