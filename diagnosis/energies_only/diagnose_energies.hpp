#pragma once

#include "diagnosis/correction/correction.hpp"
#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// The diagnosis of a dataset whose runs have no logs, only the energies of prescribed motions.
///
/// Each run is two numbers (sum of the wheels, right less left), so names are rare: the motion was not
/// recorded, and braking rate and entry speed are nuisances of 20 %. How far the gap shrinks is measured on
/// held-out rows, not used to choose or fit: `use: validation` where the dataset has it, else every run
/// in turn (four folds). Throws ConfigError where a motion cannot be driven.
[[nodiscard]] Diagnosis diagnose_energies(const Dataset& dataset, const DiagnoseOptions& options);

/// What a correction made from logs does to the dataset's runs without logs, none of which took part, as a
/// sentence; empty without such runs.
[[nodiscard]] std::string told_by_energies(const Dataset& dataset, const Correction& correction);

}  // namespace joulepath
