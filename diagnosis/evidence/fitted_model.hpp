#pragma once

#include <set>
#include <string>
#include <vector>

#include "diagnosis/evidence/identify.hpp"

namespace joulepath {

/// The identification's calibration refitted on the diagnosis runs with the given effects, and with unknown
/// terms (by label) beside them.
[[nodiscard]] Refit fit_effects(const LogSet& diagnosis, const Identification& identification,
                                const std::vector<ActiveEffect>& effects,
                                const std::set<std::string>& unknowns = {});

}  // namespace joulepath
