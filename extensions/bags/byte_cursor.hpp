#pragma once

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string_view>

namespace joulepath {

/// The data end before their announced size. Internal: readers count the skipped messages.
class BytesEnd : public std::runtime_error {
 public:
  BytesEnd() : std::runtime_error("the bytes end early") {}
};

/// Reads little-endian values from bytes; announced sizes are checked against the data. Throws BytesEnd.
class ByteCursor {
 public:
  explicit ByteCursor(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
  [[nodiscard]] std::size_t position() const { return at_; }

  std::string_view take(std::uint64_t count) {
    if (count > left()) throw BytesEnd();
    const std::string_view taken = bytes_.substr(at_, count);
    at_ += count;
    return taken;
  }
  template <class Number>
  Number number() {
    Number value{};
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  /// A length of 32 bits, then that many bytes.
  std::string_view text() { return take(number<std::uint32_t>()); }
  /// Skips to a multiple of `size` from `origin`.
  void align(std::size_t size, std::size_t origin) { take((size - (at_ - origin) % size) % size); }

 private:
  std::string_view bytes_;
  std::size_t at_{};
};

}  // namespace joulepath
