#pragma once

#include "diagnosis/verdict/examination.hpp"

namespace joulepath {

/// Fits the names on the diagnosis runs, judges on the held-out ones, and takes back what does not hold
/// there. Returns what is left, fitted.
[[nodiscard]] Correction validate(Examination& examination);

/// The gap on the held-out runs, before and after, beside its floors.
void report_gap(Examination& examination, const Correction& correction);

}  // namespace joulepath
