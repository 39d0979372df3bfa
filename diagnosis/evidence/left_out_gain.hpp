#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnosis/evidence/identify.hpp"

namespace joulepath {

/// Entries of the dictionary by what they depend on and the channel they act on: "payload (current)".
using DictionaryFamilies = std::map<std::string, std::vector<int>>;

[[nodiscard]] DictionaryFamilies dictionary_families(const Equations& equations);

/// Loss that a family saves on runs that its fit has not seen.
struct LeftOutGain {
  double gain{};          ///< sum over runs, log units times two
  double over_scatter{};  ///< the sum over its standard error between runs
};

/// What each family adds to an explanation's columns, each run judged by a fit of the others (six folds).
/// A cause repeats itself from run to run; noise that is underestimated does not.
[[nodiscard]] std::map<std::string, LeftOutGain> left_out_gains(const Identification& identification,
                                                                const std::vector<int>& columns,
                                                                const DictionaryFamilies& families);

}  // namespace joulepath
