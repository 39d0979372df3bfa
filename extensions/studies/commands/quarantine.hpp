#pragma once

#include <cstddef>
#include <map>
#include <string>

namespace joulepath {

/// Jobs that are not run, with the reason: those that killed their process. Reads JSON lines
/// {"index": 3, "reason": "killed by signal 9, 2 times"}; no file name: none. Throws ConfigError.
[[nodiscard]] std::map<std::size_t, std::string> read_quarantine(const std::string& file);

}  // namespace joulepath
