#pragma once

#include <string_view>

namespace joulepath {

/// 16 hexadecimal digits: a digest of the program's sources, of the compiler and of its flags. Results of
/// builds with the same digest may be joined. Design: docs/decisions/0700-results-and-jobs.md
extern const std::string_view kBuildId;

}  // namespace joulepath
