#pragma once

#include <set>
#include <string>
#include <vector>

namespace joulepath {

/// The effects that `--without` removes from the catalog. Throws UsageError for a name that is not in the
/// catalog, with the nearest names.
[[nodiscard]] std::set<std::string> left_out_effects(const std::vector<std::string>& names);

}  // namespace joulepath
