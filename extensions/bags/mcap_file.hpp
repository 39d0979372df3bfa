#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "scenarios/log_files/messages.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {

/// The bytes at the start and the end of an MCAP file.
inline constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};

/// Kinds of records. A record is its kind, the size of its content (64 bits) and the content.
enum class McapRecord : std::uint8_t {
  header = 0x01,
  footer,
  schema,
  channel,
  message,
  chunk,
  message_index,
  chunk_index,
  statistics = 0x0B,
  summary_offset = 0x0E,
  data_end
};

/// "the bag is truncated", with the bytes that were not read.
[[nodiscard]] std::string truncation_text(const MessageDamage& damage);
/// "no message", and why.
[[nodiscard]] std::string no_message_text(const MessageDamage& damage);

/// Reads an MCAP file from start to end, without its index: chunks uncompressed, lz4 or zstd. Broken parts
/// are skipped and counted; an announced size is checked before memory is allocated. Throws ConfigError if
/// the file cannot be read, is not an MCAP file, or unpacks without bound (UnpackedBytes).
[[nodiscard]] MessageDamage read_mcap(const std::string& file, const NamedBy& named_by,
                                      const std::function<void(const MessageChannel&)>& on_channel,
                                      const std::function<void(const TimedMessage&)>& on_message);

}  // namespace joulepath
