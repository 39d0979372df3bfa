#pragma once

#include <string>

#include "diagnosis/calibration/full_fit.hpp"

namespace joulepath::calibration {

/// Which parameters the data can separate.
struct Identifiability {
  FreeParameters free{};                          ///< to be fitted
  std::array<std::string, kFitParameters> why{};  ///< for those that are not: what is missing
};

/// Names of the parameters as results show them.
[[nodiscard]] const char* fit_parameter_name(int parameter);

/// Frees every parameter, then holds one after the other: while some direction in parameter space (scaled by
/// the robot file's values) has a standard deviation above a half by the data alone, the parameter that has
/// the largest part in it is held at the robot file's value; the payload factor already above 5 %.
[[nodiscard]] Identifiability identifiable(const FitSums& sums, const FitValues& nominal);

}  // namespace joulepath::calibration
