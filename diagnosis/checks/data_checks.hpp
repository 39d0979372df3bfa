#pragma once

#include <vector>

#include "diagnosis/signals/runs_by_use.hpp"
#include "diagnosis/values/data_check.hpp"

namespace joulepath {

/// What in the logs contradicts physics and is surely no effect: dead, inverted, swapped or scaled channels,
/// channels and clocks in another unit. A fault is sure where its repair makes relations between channels
/// hold that nothing inside calibration errors and the catalog's range explains without it. `runs` holds the
/// signals of the usable runs.
[[nodiscard]] std::vector<DataCheck> check_data(const Dataset& dataset, const RunsByUse& runs);

}  // namespace joulepath
