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

/// Whether some run turns, wide arcs included: a yaw rate of the wheels, over a second, that is no noise.
[[nodiscard]] bool has_yaw(const std::vector<RunSignals>& signals, const Geometry& geometry);

/// The run with the mean of both wheels at each wheel. Where no run has yaw, the wheels differ by noise: a
/// signature that follows it finds it again in the measured heading, which does not follow it (errors in
/// variables), and moves the half track or an unknown cause.
[[nodiscard]] RunSignals straightened(RunSignals run);
/// The same of runs that turn elsewhere: the wheels' speeds alone, where their difference is noise.
[[nodiscard]] RunSignals straightened_where_straight(RunSignals run);

/// Whether the runs state at least two payloads.
[[nodiscard]] bool has_two_payloads(const std::vector<RunSignals>& signals);

}  // namespace joulepath
