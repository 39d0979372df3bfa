#pragma once

#include <string>
#include <vector>

#include "scenarios/text/schema.hpp"

namespace joulepath {

/// All kinds with a schema: those of the core, then those of the extensions.
[[nodiscard]] const std::vector<FileKind>& file_kinds();

}  // namespace joulepath
