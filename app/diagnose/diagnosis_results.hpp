#pragma once

#include <string>

#include "diagnosis/values/diagnosis.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {

/// A diagnosis with its dataset, and its output files.
struct DiagnosisResults {
  Dataset dataset{};
  Diagnosis diagnosis{};
  std::string json{};  ///< diagnosis.json

  [[nodiscard]] std::string report() const;  ///< report.html
  /// diagnosis.json with `signals`: what every run measured, and what the model says of it.
  [[nodiscard]] std::string json_with_signals() const;
};

/// Diagnoses a dataset (`options.refusal` is set here), and plans the standard missions with the corrected
/// robot. `document` is the source of the dataset; null: its file.
[[nodiscard]] DiagnosisResults diagnosis_results(Dataset dataset, DiagnoseOptions options,
                                                 const Document* document = nullptr);

}  // namespace joulepath
