#pragma once

#include "scenarios/text/schema.hpp"

namespace joulepath {

/// Schema of an output of the program (plan, diagnosis, after, edges, loss), or of a part of one. Results may
/// have further keys in later versions.
[[nodiscard]] Schema result_schema(const std::string& name);

}  // namespace joulepath
