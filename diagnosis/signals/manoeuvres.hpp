#pragma once

#include <vector>

#include "diagnosis/signals/run_signals.hpp"

namespace joulepath {

/// What the runs drive, as shares of all samples.
struct Manoeuvres {
  double turning{}, reverse{}, still{};
};

[[nodiscard]] Manoeuvres manoeuvres_of(const std::vector<RunSignals>& signals);

[[nodiscard]] inline bool turns(const Manoeuvres& share) { return share.turning >= kLeastManoeuvreShare; }
[[nodiscard]] inline bool reverses(const Manoeuvres& share) { return share.reverse >= kLeastManoeuvreShare; }

/// Whether the runs state at least two payloads.
[[nodiscard]] bool has_two_payloads(const std::vector<RunSignals>& signals);

}  // namespace joulepath
