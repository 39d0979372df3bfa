#pragma once

#include <string_view>

/// The files of scenarios/schemas/, embedded by the build.
namespace joulepath::embedded {
extern const std::string_view file_schemas;
extern const std::string_view result_schemas;
}  // namespace joulepath::embedded
