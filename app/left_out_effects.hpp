#pragma once

#include <set>
#include <string>
#include <vector>

namespace joulepath {

/// The effects that `--without` takes out of the catalog. Throws UsageError for a name that the catalog does
/// not hold, with the nearest names.
[[nodiscard]] std::set<std::string> left_out_effects(const std::vector<std::string>& names);

}  // namespace joulepath
