#pragma once

#include "model/prescribed_motion.hpp"
#include "scenarios/text/schema.hpp"

namespace joulepath {

/// `motion:` of a mission leg or a dataset run.
[[nodiscard]] Schema motion_schema();
[[nodiscard]] PrescribedMotion read_motion(const Node& node);

/// A chain of cubic Bezier curves: four control points [x, y] each, joined end to start.
[[nodiscard]] Schema bezier_schema();
[[nodiscard]] std::vector<BezierPoints> read_bezier(const Node& node);

}  // namespace joulepath
