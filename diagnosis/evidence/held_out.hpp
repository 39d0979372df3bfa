#pragma once

#include <vector>

#include "diagnosis/evidence/identify.hpp"

namespace joulepath {

/// Loss of a model on held-out runs: loss of the whitened rows per run, own deviations of the
/// run integrated out.
[[nodiscard]] std::vector<double> held_out_losses(const LogSet& validation,
                                                  const Identification& identification,
                                                  const ModelState& state);

/// The identification's calibration refitted on the diagnosis runs with the given effects.
[[nodiscard]] ModelState refit_on_diagnosis(const LogSet& diagnosis, const Identification& identification,
                                            const std::vector<ActiveEffect>& effects,
                                            Refit* details = nullptr, int iterations = 1);

}  // namespace joulepath
