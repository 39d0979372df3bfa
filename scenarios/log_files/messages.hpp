#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace joulepath {

/// A topic of a file of messages, with the schema of its messages.
struct MessageChannel {
  std::string topic{};
  std::string type{};             ///< `nav_msgs/msg/Odometry`
  std::string schema_encoding{};  ///< ros2msg | jsonschema | ...
  std::string schema{};
  std::string encoding{};  ///< cdr | json | ...
};

struct TimedMessage {
  std::size_t channel{};  ///< in the order of the calls of on_channel
  std::uint64_t log_time_ns{};
  std::string_view data{};  ///< valid during the call only
};

/// The parts of a file of messages that were left out.
struct MessageDamage {
  bool truncated{};              ///< the file ends within a record: the recorder was killed
  std::uint64_t unread_bytes{};  ///< of a truncated MCAP file, from the record that has no end on
  std::size_t broken_chunks{};   ///< do not decompress, or have a wrong check sum
  std::size_t broken_records{};
};

}  // namespace joulepath
