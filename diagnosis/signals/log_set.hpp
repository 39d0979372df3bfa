#pragma once

#include <map>
#include <vector>

#include "diagnosis/signals/run_signals.hpp"

namespace joulepath {

/// Logs of a dataset; they are read again when the electrical channels turn out to be delayed.
struct LogSet {
  const Dataset* dataset{};
  std::vector<std::size_t> runs{};  ///< indices of the dataset's runs with a usable log
  SignalOptions options{};
  std::map<std::size_t, double> estimated_payload_kg{};  ///< of runs that state none, by index in the dataset
};

[[nodiscard]] std::vector<RunSignals> read_signals(const LogSet& logs, double channel_delay_s);

}  // namespace joulepath
