#pragma once

#include <cstdio>
#include <string>

namespace joulepath {

/// At most three significant digits, for sentences.
[[nodiscard]] inline std::string three_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

}  // namespace joulepath
