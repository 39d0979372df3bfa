#pragma once

#include "diagnosis/values/dataset.hpp"
#include "scenarios/document.hpp"

namespace joulepath {

/// Refuses a log whose numbers no robot of this kind can have (a unit that is not the column's: mA for A, rpm
/// or degrees for rad/s, ms for s) or whose wheel and body speeds do not fit the robot's wheels. Throws
/// ConfigError at `named_by`, the run's place in the dataset.
void check_plausible(const Run& run, const Robot& robot, const Node& named_by);

}  // namespace joulepath
