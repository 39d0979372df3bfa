#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace joulepath {

/// The text of a file (YAML or JSON by its name) with other values. Only the text of changed values is
/// replaced, so comments, order and notation stay. The result parses to exactly `wanted`. Throws ConfigError
/// and changes nothing where no such edit exists (aliases, texts over several lines).
[[nodiscard]] std::string with_values(const std::string& text, const std::string& file,
                                      const nlohmann::ordered_json& wanted);

}  // namespace joulepath
