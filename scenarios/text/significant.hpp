#pragma once

#include <string>

namespace joulepath {

/// Rounds to six significant digits, the precision of the data. Not finite becomes 0.
[[nodiscard]] double six_digits(double value);

/// The shortest text of a number rounded to six significant digits.
[[nodiscard]] std::string significant_text(double value);

}  // namespace joulepath
