#pragma once

#include <string>

#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// The result of a diagnosis in one sentence: verdict, causes with their sizes, and the change of the gap.
[[nodiscard]] std::string diagnosis_sentence(const Diagnosis& diagnosis);

}  // namespace joulepath
