#pragma once

#include "scenarios/robot_files/robot_draft.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {

/// Limits, wheels and footprint of a Nav2 or ros2_control parameter file.
[[nodiscard]] bool is_parameter_file(const Document& document);
[[nodiscard]] RobotDraft read_parameters_of_robot(const std::string& file, const std::vector<std::string>&);

/// Limits, mass, battery and power of the robots of a fleet in Open-RMF.
[[nodiscard]] bool is_rmf_fleet(const Document& document);
[[nodiscard]] RobotDraft read_rmf_fleet(const std::string& file, const std::vector<std::string>&);

}  // namespace joulepath
