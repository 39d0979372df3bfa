#include <cmath>
#include <nlohmann/json.hpp>

#include "scenarios/text/schema.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

Json schema_json(const Schema& schema);

Json number_json(const Schema& schema) {
  Json json{{"type", schema.kind == Schema::Kind::integer ? "integer" : "number"}};
  if (std::isfinite(schema.range.min))
    json[schema.range.above_min ? "exclusiveMinimum" : "minimum"] = schema.range.min;
  if (std::isfinite(schema.range.max)) json["maximum"] = schema.range.max;
  if (schema.range.min != 0.0 || schema.range.above_min || schema.range.least_size == 0.0) return json;
  json["minimum"] = schema.range.least_size;
  return {{"anyOf", Json::array({{{"enum", {0}}}, json})}};
}

/// Choices that YAML reads as a number or a boolean are listed as such too.
Json choice_json(const Schema& schema) {
  Json words = Json::array();
  for (const auto& word : schema.choices) {
    if (word == "true" || word == "false")
      words.push_back(word == "true");
    else if (const auto number = parse_number(word))
      words.push_back(*number == std::floor(*number) ? Json(static_cast<long>(*number)) : Json(*number));
    else
      words.push_back(word);
  }
  return {{"enum", words}};
}

Json list_json(const Schema& schema) {
  Json json{{"type", "array"}, {"items", schema_json(schema.parts.front())}};
  if (schema.min_items > 0) json["minItems"] = schema.min_items;
  if (schema.max_items < std::numeric_limits<std::size_t>::max()) json["maxItems"] = schema.max_items;
  return json;
}

Json groups_json(const Schema& schema) {
  Json all = Json::array();
  for (const auto& group : schema.exactly_one) {
    Json one = Json::array();
    for (const auto& name : group) one.push_back({{"required", {name}}});
    all.push_back({{"oneOf", one}});
  }
  return all;
}

Json map_json(const Schema& schema) {
  Json properties = Json::object(), required_keys = Json::array();
  for (const auto& key : schema.keys) {
    properties[key.name] = schema_json(key.schema);
    if (!key.says.empty()) properties[key.name]["description"] = key.says;
    if (key.required) required_keys.push_back(key.name);
  }
  Json json{{"type", "object"}, {"properties", properties}, {"additionalProperties", schema.open}};
  if (!required_keys.empty()) json["required"] = required_keys;
  if (schema.min_items > 0) json["minProperties"] = schema.min_items;
  if (schema.max_items < std::numeric_limits<std::size_t>::max()) json["maxProperties"] = schema.max_items;
  if (!schema.exactly_one.empty()) json["allOf"] = groups_json(schema);
  return json;
}

Json schema_json(const Schema& schema) {
  if (schema.nullable) {
    Schema value = schema;
    value.nullable = false;
    return {{"anyOf", Json::array({schema_json(value), Json{{"type", "null"}}})}};
  }
  switch (schema.kind) {
    case Schema::Kind::number:
    case Schema::Kind::integer:
      return number_json(schema);
    case Schema::Kind::boolean:
      return {{"type", "boolean"}};
    case Schema::Kind::text:
      return {{"type", "string"}};
    case Schema::Kind::choice:
      return choice_json(schema);
    case Schema::Kind::list:
      return list_json(schema);
    case Schema::Kind::map:
      return map_json(schema);
    case Schema::Kind::dictionary:
      return {{"type", "object"}, {"additionalProperties", schema_json(schema.parts.front())}};
    case Schema::Kind::any_of:
      break;
  }
  Json alternatives = Json::array();
  for (const auto& part : schema.parts) alternatives.push_back(schema_json(part));
  return {{"anyOf", alternatives}};
}

}  // namespace

std::string json_schema(const FileKind& kind) {
  Json json{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
            {"$id", "joulepath/" + kind.name + "/1"},
            {"title", "joulepath " + kind.name + " file, version 1"},
            {"description", kind.says}};
  json.update(schema_json(kind.schema()));
  return json.dump(2) + "\n";
}

}  // namespace joulepath
