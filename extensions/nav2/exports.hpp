#pragma once

#include "scenarios/export/exports.hpp"
#include "scenarios/text/schema.hpp"

namespace joulepath {

[[nodiscard]] Export export_controller(const ExportInput& input);     ///< JSON
[[nodiscard]] Export export_nav2_settings(const ExportInput& input);  ///< YAML
[[nodiscard]] Export export_speed_mask(const ExportInput& input);     ///< YAML and PGM

/// Of the result of export_controller().
[[nodiscard]] Schema controller_schema();

}  // namespace joulepath
