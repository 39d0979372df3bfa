#pragma once

#include "diagnosis/correction/correction.hpp"
#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// The diagnosis of a dataset whose runs have no logs, only the energies of prescribed motions.
///
/// Each run gives two numbers: the sum of the wheels' energies and their difference (right minus left). The
/// motion was not recorded, so braking rate and entry speed are nuisances of 20 %. The result is the gap, its
/// place and a ranking of candidates; no effect is named and nothing is corrected. The verdict is
/// `too_little_data` where the candidates reduce the gap of held-out rows, else `unexplained`. Held-out rows
/// are those with `use: validation`; without any, four folds hold out every run once. Throws ConfigError
/// where a motion cannot be driven.
[[nodiscard]] Diagnosis diagnose_energies(const Dataset& dataset, const DiagnoseOptions& options);

/// A sentence on how a correction fitted to logs changes the gap of the dataset's runs without logs, which
/// the fit did not use; empty without such runs.
[[nodiscard]] std::string told_by_energies(const Dataset& dataset, const Correction& correction);

}  // namespace joulepath
