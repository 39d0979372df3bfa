#pragma once

#include "diagnosis/signals/run_signals.hpp"

namespace joulepath {

/// What the kernel's mean of the supply's power has beyond mean_supply_power_W() at the mean motion (W, of
/// the rows of `mean`): by the file's robot, without effects' memory, at the samples of the same log that are
/// smoothed less. Where an acceleration jumps, the mean motion does not tell how far. Empty where `samples`
/// are no finer.
[[nodiscard]] Eigen::VectorXd supply_beyond_mean_W(const RunSignals& mean, const RunSignals& samples,
                                                   const Robot& robot);

}  // namespace joulepath
