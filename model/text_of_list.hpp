#pragma once

#include <string>
#include <string_view>

namespace joulepath {

/// The texts of a list, one after the other, with `between` after each but the last.
template <class Texts>
std::string text_of_list(const Texts& texts, std::string_view between = ", ") {
  std::string all;
  bool first = true;
  for (const auto& text : texts) {
    if (!first) all += between;
    all += text;
    first = false;
  }
  return all;
}

}  // namespace joulepath
