#pragma once

#include <string>

namespace joulepath {

/// A constant of the robot file that these runs contradict by more than any effect or calibration error.
struct ForeignConstant {
  std::string name{};  ///< in words
  std::string unit{};
  double in_file{}, in_runs{};
};

}  // namespace joulepath
