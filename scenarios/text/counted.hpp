#pragma once

#include <cstddef>
#include <string>

namespace joulepath {

/// `1 mission`, `2 missions`.
[[nodiscard]] inline std::string counted(std::size_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

}  // namespace joulepath
