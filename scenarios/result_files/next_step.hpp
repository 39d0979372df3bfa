#pragma once

#include <string>

#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// What a user does next, in one or two sentences: the verdict's step, adapted to what was found and written.
/// The terminal, diagnosis.json and the pages read it.
[[nodiscard]] std::string next_step(const Diagnosis& diagnosis);

}  // namespace joulepath
