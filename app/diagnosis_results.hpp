#pragma once

#include <string>

#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// A diagnosis with its dataset, and its output files.
struct DiagnosisResults {
  Dataset dataset{};
  Diagnosis diagnosis{};
  std::string json{};  ///< diagnosis.json

  [[nodiscard]] std::string report() const;  ///< report.html
};

/// Diagnoses a dataset, and plans the standard missions with the corrected robot.
[[nodiscard]] DiagnosisResults diagnosis_results(Dataset dataset, const DiagnoseOptions& options);

}  // namespace joulepath
