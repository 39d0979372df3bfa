#pragma once

#include <vector>

#include "diagnosis/signals/run_signals.hpp"

namespace joulepath {

/// By what a simulator's samples are those of a run: the same time, the same command at another time (two
/// clocks), or the same part of the way (two motions).
enum class AlignedBy { time, command, path };

/// A simulator's run beside the real one.
struct Alignment {
  AlignedBy by{};
  double clock_offset_s{};     ///< of the simulator's commands after the robot's; 0 without both
  double motion_difference{};  ///< rms of the wheel speeds' difference over that of the robot's wheel speeds
  std::vector<double> real_time_s{};  ///< of each of the simulator's samples, increasing
};

/// The mapping under which the wheel speeds agree best; the simplest of those that agree nearly as well.
[[nodiscard]] Alignment align(const Run& real, const RunSignals& real_signals, const Run& simulated,
                              const RunSignals& simulated_signals);

/// Time by which the second log's commands come after the first's; 0 where one has none.
[[nodiscard]] double command_offset_s(const Trajectory& first, const Trajectory& second);

}  // namespace joulepath
