#pragma once

#include <concepts>
#include <functional>
#include <string>
#include <string_view>

namespace joulepath {

/// Appends an item to a list of texts, with `between` before each but the first.
inline void append_item(std::string& list, std::string_view item, std::string_view between = ", ") {
  if (!list.empty()) list += between;
  list += item;
}

/// What `text_of` says of each item, one after the other, with `between` after each but the last.
template <class Items, class TextOf>
requires(!std::convertible_to<TextOf, std::string_view>) [[nodiscard]] std::string
    text_of_list(const Items& items, TextOf text_of, std::string_view between = ", ") {
  std::string all;
  bool first = true;
  for (const auto& item : items) {
    if (!first) all += between;
    all += std::invoke(text_of, item);
    first = false;
  }
  return all;
}

/// The texts of a list.
template <class Texts>
[[nodiscard]] std::string text_of_list(const Texts& texts, std::string_view between = ", ") {
  return text_of_list(texts, std::identity(), between);
}

}  // namespace joulepath
