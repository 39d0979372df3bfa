#pragma once

#include <string>

#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// The answer of a diagnosis in one line: verdict, causes with their sizes, and what becomes of the gap.
[[nodiscard]] std::string diagnosis_sentence(const Diagnosis& diagnosis);

}  // namespace joulepath
