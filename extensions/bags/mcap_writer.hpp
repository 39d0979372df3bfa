#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <string_view>

#include "extensions/bags/mcap_file.hpp"

namespace joulepath {

/// Writes a bag in memory: uncompressed MCAP in chunks of about 1 MiB, with an index of every message and a
/// summary, so that a reader finds topics and times without reading the whole file.
class McapWriter {
 public:
  McapWriter();

  /// Adds a topic; returns its number for message().
  std::uint16_t channel(const MessageChannel& channel);
  void message(std::uint16_t channel, std::uint64_t time_ns, std::string_view data);
  /// The whole file.
  [[nodiscard]] std::string finish();

 private:
  /// First and last time of messages.
  struct Times {
    std::uint64_t first_ns{~std::uint64_t{0}}, last_ns{};
    void add(std::uint64_t time_ns);
    void put(std::string& bytes) const;
  };

  void close_chunk();
  void add_chunk_index(std::uint64_t start, std::uint64_t index_start, const std::string& offsets);
  [[nodiscard]] std::string statistics() const;
  void put_summary();

  std::string bytes_{};
  std::uint16_t channels_{};
  std::uint32_t messages_{}, chunks_{};
  Times times_{};
  std::map<std::uint16_t, std::uint64_t> messages_of_channel_{};
  std::string chunk_{};  ///< records of the open chunk
  Times chunk_times_{};
  std::map<std::uint16_t, std::string> chunk_messages_{};      ///< times and places, by channel
  std::string schemas_{}, channel_records_{}, chunk_index_{};  ///< records of the summary
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
