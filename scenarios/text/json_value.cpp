#include "scenarios/text/json_value.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "model/text_of_list.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

/// True if a text without quotes parses back to the same text.
bool is_plain(const std::string& text) {
  const auto safe = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '.' || c == '/'; };
  if (text.empty() || !std::all_of(text.begin(), text.end(), safe)) return false;
  const auto first = static_cast<unsigned char>(text.front());
  if (!std::isalpha(first) && first != '_' && text.substr(0, 3) != "../") return false;
  std::string lower = text;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const char* word : {"true", "false", "null", "yes", "no", "on", "off", "y", "n"})
    if (lower == word) return false;
  return true;
}

std::string flow_word(const std::string& text) { return is_plain(text) ? text : Json(text).dump(); }

}  // namespace

Json json_of(const Value& value) {
  if (value.kind == Value::Kind::list) {
    Json items = Json::array();
    for (const Value& item : value.items) items.push_back(json_of(item));
    return items;
  }
  if (value.kind == Value::Kind::map) {
    Json entries = Json::object();
    for (const Value::Entry& entry : value.entries) entries[entry.key] = json_of(entry.value);
    return entries;
  }
  if (value.kind == Value::Kind::null) return nullptr;
  if (value.quoted) return value.text;
  if (value.text == "true" || value.text == "false") return value.text == "true";
  if (const auto number = parse_number(value.text)) return *number;
  return value.text;
}

std::string flow_text(const Json& value) {
  std::string text;
  const auto add = [&](const std::string& part) { append_item(text, part); };
  if (value.is_array()) {
    for (const Json& item : value) add(flow_text(item));
    return "[" + text + "]";
  }
  if (value.is_object()) {
    for (const auto& [key, item] : value.items()) add(flow_word(key) + ": " + flow_text(item));
    return "{" + text + "}";
  }
  if (value.is_string()) return flow_word(value.get<std::string>());
  if (value.is_number_float() && std::abs(value.get<double>()) < 1e15 &&
      value.get<double>() == static_cast<double>(static_cast<long>(value.get<double>())))
    return std::to_string(static_cast<long>(value.get<double>()));
  return value.dump();
}

}  // namespace joulepath
