#pragma once

#include "diagnosis/correction/causes.hpp"

namespace joulepath {

/// A wrong candidate fitted in the same way, as a control of the gap's reduction.
struct Control {
  std::string effect{};
  double shrink_fraction{};
};

/// The best explanation by one effect that is neither named nor indistinguishable from a named one; empty
/// where no effect is named.
[[nodiscard]] Control wrong_candidate(const Examination& examination, const std::vector<ActiveEffect>& named,
                                      const std::vector<Cause>& causes, const EnergyGap& gap);

}  // namespace joulepath
