#pragma once

#include <set>
#include <string>
#include <vector>

#include "diagnosis/signals/run_signals.hpp"

namespace joulepath {

/// Channels and motions that a dataset lacks, and the effects that it therefore cannot show: no log contains
/// what they need. Reported first.
struct Survey {
  std::vector<std::string> missing_channels{};
  std::vector<std::string> notes{};
  std::set<std::string> invisible_effects{};
};

[[nodiscard]] Survey survey_dataset(const Dataset& dataset, const std::vector<RunSignals>& signals);

/// Which runs state no payload, what that means, and the line of the dataset file that states it; else empty.
[[nodiscard]] std::string unstated_payload_note(const Dataset& dataset);

/// The logs that are too short to be smoothed, how long they are and what is needed; else empty.
[[nodiscard]] std::string short_runs_note(const Dataset& dataset);

/// Throws ConfigError with the first run's place where no run can be diagnosed: every log is too short, and
/// none has a measured energy with its motion.
void refuse_short_runs(const Dataset& dataset);

/// Artifacts as sentences.
[[nodiscard]] std::vector<std::string> artifact_texts(const Dataset& dataset);

}  // namespace joulepath
