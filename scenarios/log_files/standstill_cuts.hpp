#pragma once

#include <vector>

#include "diagnosis/values/dataset.hpp"

namespace joulepath {

/// Cuts long logs into runs between stops. The scatter between runs, held-out runs and intervals need several
/// runs, and the log of a whole day would be one run. Logs longer than `kLongLog_s` are cut in the middle of
/// standstills, so that each part lasts long enough to show a manoeuvre and the number of parts of all logs
/// is bounded. Logs with a value of the whole run (an energy, another prediction) are not cut. Each cut log
/// is reported among the artifacts.
[[nodiscard]] std::vector<Run> cut_at_standstill(std::vector<Run> runs, std::vector<LogArtifact>& artifacts);

}  // namespace joulepath
