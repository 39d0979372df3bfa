#pragma once

#include <string>
#include <vector>

#include "diagnosis/values/data_check.hpp"
#include "diagnosis/values/dataset.hpp"

namespace joulepath {

/// A common error of log channels, and its repair.
struct Fault {
  std::string kind{};  ///< inverted | swapped | unit | scaled | clock
  std::string channel{};
  std::vector<ColumnRepair> columns{};
};

/// The faults that the channels of a run can have: swapped sides, inverted signs, other units, a clock in
/// other units; then factors that are not unit conversions.
[[nodiscard]] std::vector<Fault> possible_faults(const Run& run);

/// The same fault with another factor.
[[nodiscard]] Fault with_factor(Fault fault, double factor);

/// The run after the repair.
[[nodiscard]] Run repaired(Run run, const std::vector<ColumnRepair>& columns, const Geometry& geometry);

}  // namespace joulepath
