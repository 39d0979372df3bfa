#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <string_view>

namespace joulepath {

/// 128 bits that identify a content: of different contents they are the same by chance alone (two of 10^12
/// contents with a probability below 10^-14). No protection against contents that are made to collide.
struct ContentKey {
  std::uint64_t first{}, second{};

  friend auto operator<=>(const ContentKey&, const ContentKey&) = default;
  /// 32 hexadecimal digits.
  [[nodiscard]] std::string text() const;
};

[[nodiscard]] ContentKey content_key(std::string_view bytes);

}  // namespace joulepath
