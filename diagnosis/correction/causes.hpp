#pragma once

#include "diagnosis/correction/validation.hpp"

namespace joulepath {

/// The named effects as they are reported, the one with the greatest share of the energy first.
struct Causes {
  std::vector<Cause> causes{};
  std::string pinned_combination{};
};

/// Each named effect with its probability, parameters, share of the energy, the gap that it closes by
/// itself, and what these runs cannot tell it from.
[[nodiscard]] Causes report_causes(const Examination& examination, const Names& names,
                                   const Validation& validation, const EnergyGap& gap);

}  // namespace joulepath
