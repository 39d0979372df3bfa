#pragma once

#include <vector>

#include "diagnosis/values/data_check.hpp"
#include "diagnosis/values/dataset.hpp"

namespace joulepath {

/// Runs with a channel in another unit, told by its noise: that of the other runs times the unit's factor. It
/// tells where the run's motion does not, as a gyro's unit on a straight drive.
[[nodiscard]] std::vector<DataCheck> noisy_units(const Dataset& dataset);

}  // namespace joulepath
