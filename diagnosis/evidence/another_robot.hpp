#pragma once

#include <vector>

#include "diagnosis/signals/runs_by_use.hpp"
#include "diagnosis/values/data_check.hpp"
#include "diagnosis/values/foreign_constant.hpp"

namespace joulepath {

/// The constants by which the runs are surely those of another robot than the file's; `checks`: the faults of
/// their logs. A fault of single runs is none of the file: another robot's file is wrong in the runs without
/// one, too. Another clock, or a filter of the wheel speeds, imitates another resistance: the logs are read
/// without it.
[[nodiscard]] std::vector<ForeignConstant> constants_of_another_robot(const Dataset& dataset,
                                                                      const RunsByUse& runs,
                                                                      const std::vector<DataCheck>& checks);

}  // namespace joulepath
