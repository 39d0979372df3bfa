#pragma once

#include <string>

namespace joulepath {

/// The shortest text that parses back to the same number, as all results and files write it.
[[nodiscard]] std::string number_text(double value);

/// Appends that text, without a string in between.
void append_number(std::string& text, double value);

}  // namespace joulepath
