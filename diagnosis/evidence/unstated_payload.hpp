#pragma once

#include "diagnosis/signals/runs_by_use.hpp"

namespace joulepath {

/// The runs with the payload of each run that states none, as its own log shows it: beside the calibration
/// and all laws of the catalog, each such run has a payload of its own (a normal prior about the last
/// estimate, see payload_prior_sd_kg()), solved by Gauss-Newton. What the estimate leaves stays a parameter
/// of the run in all equations, so a law that a payload could imitate has no evidence from these runs.
[[nodiscard]] RunsByUse with_estimated_payloads(RunsByUse runs);

}  // namespace joulepath
