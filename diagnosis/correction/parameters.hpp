#pragma once

#include "diagnosis/evidence/refit.hpp"
#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// The parameters of a refit's effect as its file says them, each with a 95 % interval.
[[nodiscard]] std::vector<FoundParameter> found_parameters(const Refit& fitted, std::size_t effect,
                                                           const Robot& robot);

}  // namespace joulepath
