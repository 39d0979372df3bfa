#pragma once

#include <vector>

#include "diagnosis/values/dataset.hpp"

namespace joulepath {

/// Long logs as runs between stops. Evidence is weighed run by run: the scatter between runs, the runs held
/// out and every interval need several of them, and one file of a whole day is one. Logs longer than
/// `kLongLog_s` are cut in the middle of standstills, so that each part lasts long enough to show a manoeuvre
/// and all logs together have a bounded number of parts. Logs with a value of the whole run (an energy,
/// another prediction) stay whole. Each cut log is reported among the artifacts.
[[nodiscard]] std::vector<Run> cut_at_standstill(std::vector<Run> runs, std::vector<LogArtifact>& artifacts);

}  // namespace joulepath
