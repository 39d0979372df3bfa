#pragma once

#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// The diagnosis of a dataset whose runs have no logs, only the energies of prescribed motions.
///
/// Each run is two numbers (sum of the wheels, right less left), so names are rare: the motion was not
/// recorded, and braking rate and entry speed are nuisances of 20 %. How far the gap shrinks is measured on
/// rows that took no part in choosing or fitting: `use: validation` where the dataset says it, else every run
/// in turn (four folds). Throws ConfigError where a motion cannot be driven.
[[nodiscard]] Diagnosis diagnose_energies(const Dataset& dataset, const DiagnoseOptions& options);

/// Adds to a diagnosis made from logs what its correction does to the dataset's runs without logs, none of
/// which took part.
void judge_on_energies(const Dataset& dataset, Diagnosis& diagnosis);

}  // namespace joulepath
