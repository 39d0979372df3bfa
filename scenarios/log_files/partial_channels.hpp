#pragma once

#include <string>
#include <vector>

#include "diagnosis/values/dataset.hpp"

namespace joulepath {

/// A channel that begins late or ends early, in its file or with it: NaN at an end of the log. No reader of a
/// dataset hands it on.
[[nodiscard]] bool is_partial(const std::vector<double>& channel);

/// Leaves partial channels out, so that all of the log is kept, and says so. Ends of less than a fiftieth of
/// the log that a channel misses are cut instead.
void drop_partial_channels(Trajectory& log, const std::string& run, std::vector<LogArtifact>& artifacts);

/// The run as runs whose channels are known throughout: a new one begins where a channel does. Stretches too
/// short for a run of their own are left out; every cut is said. A run with values of the whole (a measured
/// energy, a prediction) is kept whole, without its partial channels.
[[nodiscard]] std::vector<Run> split_at_partial_channels(Run run, std::vector<LogArtifact>& artifacts);

}  // namespace joulepath
