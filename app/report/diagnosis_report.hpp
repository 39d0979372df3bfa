#pragma once

#include <string>

#include "diagnosis/values/diagnosis.hpp"

namespace joulepath::report {

/// The HTML report of a diagnosis: `diagnosis_json` as written to diagnosis.json, and every usable run of the
/// dataset with the predictions of the nominal and the corrected model.
[[nodiscard]] std::string diagnosis_report(const Diagnosis& diagnosis, const std::string& diagnosis_json,
                                           const Dataset& dataset);

}  // namespace joulepath::report
