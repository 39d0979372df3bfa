#pragma once

#include <vector>

#include "diagnosis/signals/run_signals.hpp"

namespace joulepath {

/// Logs of a dataset, read anew where the electrical channels turn out to be late.
struct LogSet {
  const Dataset* dataset{};
  std::vector<std::size_t> runs{};  ///< of the dataset, those with a usable log
  SignalOptions options{};
};

[[nodiscard]] std::vector<RunSignals> read_signals(const LogSet& logs, double channel_delay_s);

}  // namespace joulepath
