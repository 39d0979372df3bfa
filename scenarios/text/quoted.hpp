#pragma once

#include <string>

namespace joulepath {

/// A text in double quotes with escapes, as YAML and JSON read it. Bytes that are not UTF-8 are replaced.
[[nodiscard]] std::string quoted(const std::string& text);

}  // namespace joulepath
