#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "scenarios/bags/mcap_file.hpp"

namespace joulepath {

/// Writes a bag in memory: MCAP without chunks and without an index.
class McapWriter {
 public:
  McapWriter();

  /// Adds a topic; returns its number for message().
  std::uint16_t channel(const BagChannel& channel);
  void message(std::uint16_t channel, std::uint64_t time_ns, std::string_view data);
  /// The whole file.
  [[nodiscard]] std::string finish();

 private:
  void record(std::uint8_t opcode, std::string_view content);

  std::string bytes_{};
  std::uint16_t channels_{};
  std::uint32_t messages_{};
};

/// A message in CDR, little-endian.
class CdrWriter {
 public:
  template <class Number>
  CdrWriter& number(Number value) {
    while ((bytes_.size() - 4) % sizeof value != 0) bytes_ += '\0';
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes_.append(raw, sizeof value);
    return *this;
  }
  CdrWriter& text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size() + 1));
    bytes_.append(value);
    bytes_ += '\0';
    return *this;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_{std::string("\0\1\0\0", 4)};
};

}  // namespace joulepath
