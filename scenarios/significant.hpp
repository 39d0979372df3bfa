#pragma once

#include <string>

namespace joulepath {

/// Six significant digits: what was measured, not what the arithmetic left. Not finite becomes 0.
[[nodiscard]] double six_digits(double value);

/// The shortest text of that number.
[[nodiscard]] std::string significant_text(double value);

}  // namespace joulepath
