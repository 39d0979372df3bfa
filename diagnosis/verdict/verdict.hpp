#pragma once

#include "diagnosis/verdict/examination.hpp"

namespace joulepath {

/// A leftover above this share of what could be explained takes the names away.
inline constexpr double kUnexplainedShare = 0.45;

/// Verdict and names by the diagnosis runs, before the held-out runs have a say.
void judge(Examination& examination);

}  // namespace joulepath
