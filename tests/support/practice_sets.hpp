#pragma once

#include <string>

#include "tests/support/locations.hpp"

namespace joulepath::testing {

/// A file of a labelled set in tests/data/practice; its README says where the sets come from.
inline std::string practice_file(const std::string& set, const std::string& file = "dataset.yaml") {
  return JOULEPATH_SOURCE_DIR "/tests/data/practice/" + set + "/" + file;
}

}  // namespace joulepath::testing
