#pragma once

#include <string>

#include "diagnosis/calibration/full_fit.hpp"

namespace joulepath::calibration {

/// The parameters that the data can separate.
struct Identifiability {
  FreeParameters free{};                          ///< to be fitted
  std::array<std::string, kFitParameters> why{};  ///< for each parameter that is held: the missing data
};

/// Name of a parameter in results.
[[nodiscard]] const char* fit_parameter_name(int parameter);

/// Starts with every parameter free and holds one after the other at the value of the robot file: while a
/// direction in parameter space (scaled by the robot file's values) has a standard deviation above one half
/// from the data alone, the parameter with the largest part in that direction is held. For the payload factor
/// the threshold is 5 %.
[[nodiscard]] Identifiability identifiable(const FitSums& sums, const FitValues& nominal);

}  // namespace joulepath::calibration
