#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace joulepath::report {

/// JSON that may stand inside of a script element: no "<" can close it or open a comment.
[[nodiscard]] std::string script_safe(const nlohmann::json& data);

/// Text of an HTML element.
[[nodiscard]] std::string escaped(std::string_view text);

/// One pass over a page: a name between @ signs is replaced where it is known, and nothing that is put in is
/// looked at again.
[[nodiscard]] std::string filled(std::string_view page,
                                 const std::vector<std::pair<std::string_view, std::string>>& values);

}  // namespace joulepath::report
