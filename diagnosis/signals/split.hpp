#pragma once

#include <vector>

#include "diagnosis/values/dataset.hpp"

namespace joulepath {

/// Which runs of a dataset choose and fit, and which only judge.
struct RunSplit {
  std::vector<std::size_t> diagnosis{};  ///< indices into Dataset::runs, in the dataset's order
  std::vector<std::size_t> validation{};
};

inline constexpr std::size_t kLeastRuns = 4;  ///< below this nothing is named

/// `use:` where a dataset says it; else about every fourth run, spread over payloads and manoeuvres.
/// Depends on what is in the runs, not on their order.
[[nodiscard]] RunSplit split_runs(const Dataset& dataset, const std::vector<std::size_t>& usable);

}  // namespace joulepath
