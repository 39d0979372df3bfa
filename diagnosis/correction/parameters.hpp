#pragma once

#include "diagnosis/evidence/refit.hpp"
#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// The parameters of a refit's effect as its file says them, each with a 95 % interval.
[[nodiscard]] std::vector<FoundParameter> found_parameters(const Refit& fitted, std::size_t effect,
                                                           const Robot& robot);

/// Correlations of the effects' strengths with each other and with calibration constants, where they matter,
/// by the noise model's covariance; the strongest first.
[[nodiscard]] std::vector<ParameterCorrelation> parameter_correlations(
    const Refit& fitted, const std::vector<Nuisance>& nuisances);

/// Whether the 95 % region of an effect's amplitudes leaves out 0 (no effect).
[[nodiscard]] bool is_told_from_zero(const Refit& fitted, std::size_t effect);

/// Whether an effect's strength is one that the catalog accepts.
[[nodiscard]] bool is_inside_range(const Refit& fitted, std::size_t effect, const Robot& robot);

}  // namespace joulepath
