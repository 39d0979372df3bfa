#pragma once

#include <string>

#include "diagnosis/evidence/identify.hpp"

namespace joulepath {

/// What the catalog's best explanation leaves that something else could still explain.
struct Leftover {
  bool significant{};
  double share{};             ///< of what anything could explain beyond calibration and noise
  double evidence{};          ///< log units beyond what chance would give the dictionary
  std::string description{};  ///< what it depends on, strongest first
};

/// Compares the explanation with a dictionary of everything that was measured.
[[nodiscard]] Leftover find_leftover(const Identification& identification, const std::vector<int>& columns);

}  // namespace joulepath
