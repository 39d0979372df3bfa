#pragma once

#include <string>

namespace joulepath {

/// A channel with values that no robot of this kind can have: a unit other than the column's (mA for A, rpm
/// or degrees for rad/s, ms for s), or wheel and body speeds that do not fit the robot's wheels.
struct Implausible {
  std::string channel{};
  std::string found{};
  std::string accepted{};
  std::string hint{};
};

}  // namespace joulepath
