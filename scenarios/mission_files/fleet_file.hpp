#pragma once

#include <string>

#include "planner/values/fleet_request.hpp"
#include "scenarios/text/schema.hpp"

namespace joulepath {

[[nodiscard]] Schema fleet_schema();

/// Reads a fleet file; robots and missions that it names are resolved, not read. Throws ConfigError.
[[nodiscard]] Fleet read_fleet(const std::string& file, const ReadOptions& options = {});

}  // namespace joulepath
