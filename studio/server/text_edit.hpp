#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace joulepath::studio {

/// A file's text (YAML or JSON by the name) with other values: only the text of what differs is replaced, so
/// that comments, order and notation stay. The result reads back as exactly `wanted`; where no edit leads
/// there (aliases, texts over several lines), throws ConfigError and nothing is changed.
[[nodiscard]] std::string with_values(const std::string& text, const std::string& file,
                                      const nlohmann::ordered_json& wanted);

}  // namespace joulepath::studio
