#pragma once

#include <string>
#include <vector>

#include "extensions/fleet/fleet_request.hpp"
#include "scenarios/text/schema.hpp"

namespace joulepath {

[[nodiscard]] Schema fleet_schema();

/// Reads a fleet file; the files that it names are resolved, not read. Throws ConfigError.
[[nodiscard]] Fleet read_fleet(const std::string& file, const ReadOptions& options = {});
[[nodiscard]] Fleet fleet_from(const Document& document, const ReadOptions& options = {});

/// What a fleet file says that no fleet has: chargers too weak, shifts shorter than every mission.
[[nodiscard]] std::vector<std::string> fleet_notes(const Fleet& fleet);

}  // namespace joulepath
