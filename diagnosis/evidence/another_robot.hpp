#pragma once

#include <string>
#include <vector>

#include "diagnosis/signals/runs_by_use.hpp"
#include "diagnosis/values/data_check.hpp"
#include "diagnosis/values/foreign_constant.hpp"

namespace joulepath {

struct AnotherRobot {
  std::vector<ForeignConstant> constants{};  ///< by which the runs are surely not those of the file's robot
  std::vector<std::string> notes{};          ///< geometry that the pose tells, as questions
};

/// `checks`: the faults of the runs' logs. The pose tells the geometry first; inertias are asked with it. A
/// fault of single runs is none of the file: another robot's file is wrong in the runs without one, too.
/// Another clock, or a filter of the wheel speeds, imitates another resistance: the logs are read without it.
[[nodiscard]] AnotherRobot another_robot(const Dataset& dataset, const RunsByUse& runs,
                                         const std::vector<DataCheck>& checks);

}  // namespace joulepath
