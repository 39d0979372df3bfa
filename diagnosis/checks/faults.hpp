#pragma once

#include <string>
#include <vector>

#include "diagnosis/values/data_check.hpp"
#include "diagnosis/values/dataset.hpp"

namespace joulepath {

/// One way in which the channels of a log are often wrong, and the repair.
struct Fault {
  std::string kind{};  ///< inverted | swapped | unit | scaled | clock
  std::string channel{};
  std::vector<ColumnRepair> columns{};
};

/// The faults that the channels of a run can have: sides swapped, signs inverted, other units, the clock in
/// other units; at last, factors that are no unit.
[[nodiscard]] std::vector<Fault> possible_faults(const Run& run);

/// The same with another factor.
[[nodiscard]] Fault with_factor(Fault fault, double factor);

/// The run as it is with the repair.
[[nodiscard]] Run repaired(Run run, const std::vector<ColumnRepair>& columns, const Geometry& geometry);

}  // namespace joulepath
