#pragma once

#include <set>
#include <string>
#include <vector>

#include "diagnosis/prediction/candidates.hpp"
#include "diagnosis/prediction/model_state.hpp"

namespace joulepath {

/// For each effect that acts inside a region of the floor, the regions in which the wheels need more than
/// elsewhere: a scan over strips and
/// rectangles along the travelled places for the greatest contrast of the mechanics residual, inside
/// against outside. Edges lie between the last sample inside and the next one outside; where nobody
/// drove, the edge is as far as the robots went. Empty without a pose.
[[nodiscard]] std::vector<Candidate> region_candidates(const std::vector<RunSignals>& signals,
                                                       const Robot& robot,
                                                       const std::vector<Nuisance>& nuisances,
                                                       const ModelState& state,
                                                       const std::set<std::string>& without = {});

}  // namespace joulepath
