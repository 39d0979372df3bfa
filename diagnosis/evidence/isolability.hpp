#pragma once

#include <set>
#include <string>
#include <vector>

#include "diagnosis/evidence/equations.hpp"
#include "diagnosis/signals/runs_by_use.hpp"
#include "diagnosis/values/isolability.hpp"

namespace joulepath {

/// Noise of the channels and scatter between the runs of a dataset.
struct RunNoise {
  NoiseModel noise{};
  Eigen::VectorXd run_variance{};
  double dispersion{1.0};
};

/// The noise that a fit of the whole catalog and dictionary about the nominal model leaves.
[[nodiscard]] RunNoise noise_of_runs(const std::vector<RunSignals>& signals, const Robot& robot,
                                     const std::set<std::string>& without);

/// Which effects of the catalog these runs would show, and which pairs they would tell apart, from the
/// equations of the race about the nominal model and without any residual. Data with effect a of its typical
/// size are fitted with effect b, its amplitude free within what the catalog accepts, its strength free to
/// vary as an inexact form does, and with the calibration within its uncertainty:
///   D(a, b) = min_b |a - b|^2,  2 ln LR ~ N(D, 4 D)
/// A pair has the lesser of D(a, b) and D(b, a). `invisible` effects lack a channel or a manoeuvre; effects
/// `without` are taken out of the catalog; a diagnosis found the effects with the labels `found`.
[[nodiscard]] Isolability isolability(const std::vector<RunSignals>& signals, const Robot& robot,
                                      const RunNoise& noise, const std::set<std::string>& invisible,
                                      const std::set<std::string>& without = {},
                                      const std::set<std::string>& found = {});

/// The same of a dataset's diagnosis runs before a diagnosis.
[[nodiscard]] Isolability isolability(const Dataset& dataset, const RunsByUse& runs);

}  // namespace joulepath
