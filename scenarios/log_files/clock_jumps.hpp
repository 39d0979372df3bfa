#pragma once

#include <vector>

#include "diagnosis/values/dataset.hpp"

namespace joulepath {

/// The stretches of a run between samples. Each later one has a clock of its own; stretches of one sample are
/// left out.
[[nodiscard]] std::vector<Run> stretches_between(Run run, const std::vector<std::size_t>& bounds);

/// Splits a run whose clock jumps into one run per stretch between the jumps. The motion during a jump is
/// unknown, so nothing may be interpolated or integrated across it. A jump is a step of more than 60 s and of
/// more than 100 usual steps. Each later stretch has a clock that begins at 0; stretches of one sample are
/// left out. Each jump is reported among the artifacts.
[[nodiscard]] std::vector<Run> split_at_clock_jumps(Run run, std::vector<LogArtifact>& artifacts);

}  // namespace joulepath
