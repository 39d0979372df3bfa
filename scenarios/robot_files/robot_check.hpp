#pragma once

#include <array>
#include <string>
#include <vector>

#include "model/robot.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {

/// Checks beyond the schema. Throws ConfigError at the key: torque and voltage constants that no motor has
/// together.
void check_robot(const Node& root, const Robot& robot);

/// Throws ConfigError at the corner for an outline that crosses itself.
void check_polygon(const Node& polygon, const std::vector<std::array<double, 2>>& corners);

/// Throws ConfigError at the key of the last of these pairs of `uncertainty_correlations:`: a key without an
/// error of the calibration, the same key or pair twice, a correlation of 1.
void check_correlation(const Node& item, const Robot& robot, const std::vector<Correlation>& pairs);

/// Throws ConfigError at the last pair that breaks it for a matrix that is not positive definite.
void check_correlation_matrix(const Node& list, Robot robot, const std::vector<Correlation>& pairs);

/// Whether the robot's outline is known.
[[nodiscard]] bool has_footprint(const Robot& robot);

/// Unusual values: constants that differ or that mass and size contradict, wheels outside of the footprint.
[[nodiscard]] std::vector<std::string> robot_notes(const Robot& robot);

}  // namespace joulepath
