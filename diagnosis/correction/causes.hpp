#pragma once

#include "diagnosis/correction/validation.hpp"

namespace joulepath {

/// The named effects as reported, in decreasing order of their share of the energy.
struct Causes {
  std::vector<Cause> causes{};
  std::string pinned_combination{};
  std::vector<ParameterCorrelation> correlations{};
};

/// Reports each named effect with its probability, parameters, share of the energy, the gap that it closes
/// alone, and the effects that these runs cannot separate from it.
[[nodiscard]] Causes report_causes(const Examination& examination, const Names& names,
                                   const Validation& validation, const EnergyGap& gap);

}  // namespace joulepath
