#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "extensions/bags/mcap_file.hpp"

namespace joulepath {

/// Extracts the requested numbers from the messages of one topic.
class MessageNumbers {
 public:
  virtual ~MessageNumbers() = default;

  /// Whether messages of this type have the field of a path.
  [[nodiscard]] virtual bool has(const std::string& path) const = 0;

  /// Requests one more number; it gets the next index of the values.
  virtual void want(const std::string& path) = 0;

  /// The requested numbers of a message, NaN for absent ones. Throws BytesEnd for a broken message.
  virtual void read(std::string_view data, std::vector<double>& values) = 0;

  /// The names of elements beside a topic's arrays of numbers (the joints of a JointState).
  [[nodiscard]] virtual std::vector<std::string> element_names(std::string_view data) = 0;
};

/// The reader of a topic's messages (CDR with a ros2msg definition or of a known type, or JSON); null for
/// other encodings.
[[nodiscard]] std::unique_ptr<MessageNumbers> message_numbers(const MessageChannel& channel);

/// For CDR (little-endian, version 1) and for JSON.
[[nodiscard]] std::unique_ptr<MessageNumbers> cdr_numbers(const MessageChannel& channel);
[[nodiscard]] std::unique_ptr<MessageNumbers> json_numbers();

}  // namespace joulepath
