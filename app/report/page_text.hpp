#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace joulepath::report {

/// JSON for a script element: no "<" in it can close the element or open a comment.
[[nodiscard]] std::string script_safe(const nlohmann::json& data);

/// Text of an HTML element.
[[nodiscard]] std::string escaped(std::string_view text);

/// Replaces every known name between @ signs in one pass; inserted text is not searched again.
[[nodiscard]] std::string filled(std::string_view page,
                                 const std::vector<std::pair<std::string_view, std::string>>& values);

}  // namespace joulepath::report
