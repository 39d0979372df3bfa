#pragma once

#include "model/robot.hpp"

namespace joulepath::python {

/// A robot that Python owns; it never changes.
struct RobotValue {
  Robot robot{};
};

}  // namespace joulepath::python
