#pragma once

#include <string>

#include "diagnosis/correction/validation.hpp"
#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// A verdict that says that all is well, or all is explained, after the question what the runs could have
/// shown.
struct AllClear {
  Verdict verdict{};
  /// A gap of this size (% of the energy), made by an effect of the catalog, is seen in 90 % of such
  /// datasets; 0: not asked, as the verdict is no all-clear.
  double detectable_percent{};
  std::string note{};
};

[[nodiscard]] AllClear examine_all_clear(const Examination& x, Verdict verdict);

}  // namespace joulepath
