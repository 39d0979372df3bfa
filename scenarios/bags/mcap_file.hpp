#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "scenarios/document.hpp"

namespace joulepath {

/// What an MCAP file begins and ends with.
inline constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};

/// A topic of a bag, as its messages' schema describes it.
struct BagChannel {
  std::string topic{};
  std::string type{};             ///< `nav_msgs/msg/Odometry`
  std::string schema_encoding{};  ///< ros2msg | jsonschema | ...
  std::string schema{};
  std::string encoding{};  ///< cdr | json | ...
};

struct BagMessage {
  std::size_t channel{};  ///< in the order in which on_channel saw them
  std::uint64_t log_time_ns{};
  std::string_view data{};  ///< during the call alone
};

/// What was left out of a bag.
struct BagDamage {
  bool truncated{};             ///< it ends in the middle: the recorder was stopped hard
  std::size_t broken_chunks{};  ///< that do not decompress, or whose check sum is wrong
  std::size_t broken_records{};
};

/// Reads an MCAP file from its start to its end, without its index: chunks uncompressed, lz4 or zstd. What is
/// broken is skipped and counted; no announced size is allocated before it is checked. Throws ConfigError
/// where the file cannot be read or is no MCAP file.
[[nodiscard]] BagDamage read_mcap(const std::string& file, const NamedBy& named_by,
                                  const std::function<void(const BagChannel&)>& on_channel,
                                  const std::function<void(const BagMessage&)>& on_message);

}  // namespace joulepath
