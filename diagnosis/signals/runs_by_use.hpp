#pragma once

#include <vector>

#include "diagnosis/signals/log_set.hpp"

namespace joulepath {

/// The runs of a dataset by what they are for.
struct RunsByUse {
  bool few{};                         ///< too few with a usable log to name anything: each is in both sets
  LogSet diagnosis{};                 ///< runs that choose and fit
  LogSet validation{};                ///< runs that judge only
  SignalOptions options{};            ///< how their logs are read
  std::vector<RunSignals> signals{};  ///< of all usable runs, electrical channels as logged
};

/// Splits the usable runs as the dataset's `use:` says; without it, about every fourth run judges, spread
/// over payloads and manoeuvres. The split depends on what is in the runs, not on their order.
[[nodiscard]] RunsByUse sort_runs(const Dataset& dataset);

}  // namespace joulepath
