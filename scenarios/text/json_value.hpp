#pragma once

#include <nlohmann/json_fwd.hpp>

#include "scenarios/text/document.hpp"

namespace joulepath {

/// A parsed value as JSON: numbers, true and false keep their type, everything else is a string.
[[nodiscard]] nlohmann::ordered_json json_of(const Value& value);

/// JSON as YAML in one line: {to: dock, payload_kg: 5.7}.
[[nodiscard]] std::string flow_text(const nlohmann::ordered_json& value);

}  // namespace joulepath
