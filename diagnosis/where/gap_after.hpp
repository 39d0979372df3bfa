#pragma once

#include <string>
#include <vector>

#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// The gap of a simulator on some runs before and after it was changed, with nothing fitted.
struct GapAfter {
  GapReport gap{};
  std::vector<std::string> runs{};  ///< that judge, by name
};

/// `before` and `after` are the same runs with the predictions of the simulator before and after a change.
/// Both are taken to the measured motion as in compare_runs(), with the dataset's robot. The runs named in
/// `held_out` judge; the shrink's interval resamples them. Throws ConfigError for a prediction of another
/// motion.
[[nodiscard]] GapAfter gap_after(const Dataset& before, const Dataset& after,
                                 const std::vector<std::string>& held_out, double noise_floor_percent,
                                 double battery_floor_percent, std::size_t bootstrap = 400);

}  // namespace joulepath
