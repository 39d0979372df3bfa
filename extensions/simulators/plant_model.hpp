#pragma once

#include <string>

#include "scenarios/mission_files/foreign_graph.hpp"

namespace joulepath {

/// A plant model of openTCS: points and paths in millimeters.
[[nodiscard]] bool is_plant_model(const std::string& file);
[[nodiscard]] ForeignGraph read_plant_model(const std::string& file);

}  // namespace joulepath
