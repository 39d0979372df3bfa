#pragma once

#include "diagnosis/correction/correction.hpp"
#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// The diagnosis of a dataset whose runs have no logs, only the energies of prescribed motions.
///
/// Each run is two numbers (sum of the wheels, right less left), and nobody recorded the motion: braking rate
/// and entry speed are nuisances of 20 %. The answer is the gap, where it lies, and the candidates in their
/// order; nothing is named or corrected. `too_little_data` where the candidates shrink the gap of held-out
/// rows (`use: validation` where the dataset says it, else every run in turn, four folds), `unexplained`
/// where they do not. Throws ConfigError where a motion cannot be driven.
[[nodiscard]] Diagnosis diagnose_energies(const Dataset& dataset, const DiagnoseOptions& options);

/// What a correction made from logs does to the dataset's runs without logs, none of which took part, as a
/// sentence; empty without such runs.
[[nodiscard]] std::string told_by_energies(const Dataset& dataset, const Correction& correction);

}  // namespace joulepath
