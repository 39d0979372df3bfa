#pragma once

#include <vector>

#include "diagnosis/checks/faults.hpp"
#include "diagnosis/signals/run_signals.hpp"

namespace joulepath {

/// A channel that does not follow what the others ask of it.
struct DeadChannel {
  std::vector<std::string> columns{};
  double followed{};  ///< part of the expected change that it shows; 1 = all
  bool needed{};      ///< without it the run says nothing: a wheel's speed
};

[[nodiscard]] std::vector<DeadChannel> dead_channels(const RunSignals& run, const Robot& robot);

}  // namespace joulepath
