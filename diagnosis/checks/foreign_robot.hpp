#pragma once

#include <vector>

#include "diagnosis/signals/run_signals.hpp"
#include "diagnosis/values/foreign_constant.hpp"

namespace joulepath {

/// Constants by which the runs are those of another robot than the file's: the windings' resistance, the
/// voltage per wheel speed, and the inertia that the wheels accelerate, each by least squares over all
/// runs with voltages and currents. A constant counts where it is surely beyond the boxes of the channels'
/// relations. Empty where the runs do not determine them, and, if a channel may be scaled, where one scale of
/// one channel explains all: a fault of the log.
[[nodiscard]] std::vector<ForeignConstant> foreign_constants(const Robot& robot,
                                                             const std::vector<RunSignals>& runs,
                                                             bool may_be_scaled = true);

}  // namespace joulepath
