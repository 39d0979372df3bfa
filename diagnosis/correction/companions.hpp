#pragma once

#include <optional>
#include <set>
#include <string>

#include "diagnosis/evidence/refit.hpp"
#include "diagnosis/verdict/examination.hpp"

namespace joulepath {

/// Of several fitted effects the one that is there only by another's linearization or form: about the fit,
/// its own evidence beside the others and some unknown terms is below what it takes to name it at its size.
/// The one furthest below first.
[[nodiscard]] std::optional<std::size_t> weakest_companion(const Examination& examination,
                                                           const Refit& fitted,
                                                           const std::set<std::string>& terms);

}  // namespace joulepath
