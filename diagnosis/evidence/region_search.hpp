#pragma once

#include <set>
#include <string>
#include <vector>

#include "diagnosis/prediction/candidates.hpp"
#include "diagnosis/prediction/model_state.hpp"

namespace joulepath {

/// Regions of the floor with the greatest need of power beyond the model, for each effect that acts inside a
/// region. A scan over strips and rectangles along the driven places finds the greatest contrast of the
/// mechanics residual between inside and outside. An edge lies between the last sample inside and the next
/// one outside; beyond the driven places it lies at their limit. Empty without a pose.
[[nodiscard]] std::vector<Candidate> region_candidates(const std::vector<RunSignals>& signals,
                                                       const Robot& robot,
                                                       const std::vector<Nuisance>& nuisances,
                                                       const ModelState& state,
                                                       const std::set<std::string>& without = {});

}  // namespace joulepath
