#pragma once

#include <string>

#include "app/report/report.hpp"
#include "diagnosis/values/diagnosis.hpp"

namespace joulepath::report {

/// Every usable run (at most 40): each measured signal, smoothed as the diagnosis works on it, and what the
/// nominal and the corrected model predict for the measured motion. Held-out runs come first.
[[nodiscard]] std::vector<RunComparison> run_comparisons(const Diagnosis& diagnosis, const Dataset& dataset);

/// The HTML report of a diagnosis: `diagnosis_json` as written to diagnosis.json, and every usable run of the
/// dataset with the predictions of the nominal and the corrected model.
[[nodiscard]] std::string diagnosis_report(const Diagnosis& diagnosis, const std::string& diagnosis_json,
                                           const Dataset& dataset);

}  // namespace joulepath::report
