#pragma once

#include <vector>

#include "diagnosis/checks/faults.hpp"
#include "diagnosis/signals/run_signals.hpp"

namespace joulepath {

/// A channel that does not follow the change that the other channels imply.
struct DeadChannel {
  std::vector<std::string> columns{};
  double followed{};  ///< share of the expected change that the channel shows; 1 = all
  bool needed{};      ///< the run cannot be used without this channel (a wheel's speed)
};

[[nodiscard]] std::vector<DeadChannel> dead_channels(const RunSignals& run, const Robot& robot);

}  // namespace joulepath
