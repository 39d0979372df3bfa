#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <string_view>

namespace joulepath {

/// 128-bit hash of a content. Different contents have equal keys only by chance (two of 10^12 contents with a
/// probability below 10^-14). It does not protect against contents made to collide.
struct ContentKey {
  std::uint64_t first{}, second{};

  friend auto operator<=>(const ContentKey&, const ContentKey&) = default;
  /// 32 hexadecimal digits.
  [[nodiscard]] std::string text() const;
};

[[nodiscard]] ContentKey content_key(std::string_view bytes);

}  // namespace joulepath
