#pragma once

#include <vector>

#include "diagnosis/signals/runs_by_use.hpp"
#include "diagnosis/values/data_check.hpp"

namespace joulepath {

/// Finds log errors that contradict physics and cannot be an effect: dead, inverted, swapped or scaled
/// channels, and channels or clocks in another unit. A fault is reported where its repair restores relations
/// between channels that no calibration error and no effect of the catalog explains without it. `runs` holds
/// the signals of the usable runs.
[[nodiscard]] std::vector<DataCheck> check_data(const Dataset& dataset, const RunsByUse& runs);

}  // namespace joulepath
