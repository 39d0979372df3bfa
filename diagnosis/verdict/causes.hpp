#pragma once

#include "diagnosis/verdict/examination.hpp"

namespace joulepath {

/// Each named effect with its probability, parameters, share of the energy, the gap that it closes by
/// itself, and what these runs cannot tell it from.
void report_causes(Examination& examination, const Correction& correction);

}  // namespace joulepath
