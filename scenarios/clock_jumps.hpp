#pragma once

#include <vector>

#include "diagnosis/values/dataset.hpp"

namespace joulepath {

/// The stretches of a run between samples, each later one with a clock of its own; those of one sample are
/// left out.
[[nodiscard]] std::vector<Run> stretches_between(Run run, const std::vector<std::size_t>& bounds);

/// A run whose clock jumps, as one run for each stretch between the jumps: nobody knows what the robot did
/// meanwhile, so that nothing may be interpolated or integrated across. A jump is a step of more than 60 s
/// and of more than 100 usual steps. Each later stretch has a clock of its own that begins at 0; stretches of
/// one sample are left out. Each jump is reported among the artifacts.
[[nodiscard]] std::vector<Run> split_at_clock_jumps(Run run, std::vector<LogArtifact>& artifacts);

}  // namespace joulepath
