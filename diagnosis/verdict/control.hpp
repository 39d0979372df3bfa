#pragma once

#include "diagnosis/verdict/examination.hpp"

namespace joulepath {

/// What the shrink is held against: a wrong candidate fitted the same way, and the ceiling that the
/// noise floor leaves.
void report_control(Examination& examination);

}  // namespace joulepath
