#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace joulepath {

/// What stands for a name between @ signs.
using Fillings = std::vector<std::pair<std::string_view, std::string>>;

/// Replaces every known name between @ signs in one pass; inserted text is not searched again.
inline std::string filled(std::string_view page, const Fillings& values) {
  std::string out;
  while (!page.empty()) {
    const std::size_t at = page.find('@');
    out += page.substr(0, at);
    if (at == std::string_view::npos) break;
    page.remove_prefix(at);
    bool known = false;
    for (const auto& [name, value] : values) {
      if (!page.starts_with(name)) continue;
      out += value;
      page.remove_prefix(name.size());
      known = true;
      break;
    }
    if (known) continue;
    out += '@';
    page.remove_prefix(1);
  }
  return out;
}

}  // namespace joulepath
