#pragma once

#include "extensions/bags/mcap_file.hpp"

namespace joulepath {

/// Whether a name is read as a bag: `.mcap`, `.db3`, a folder with rosbag2's metadata.yaml, or
/// a file of a MessageReader.
[[nodiscard]] bool is_bag(const std::string& file);

/// Reads a bag of any kind; the files of a folder in the order of its metadata. A topic is one channel, even
/// with several writers and files. Throws ConfigError, also for more messages or unpacked bytes than the size
/// of the files explains: memory stays in proportion to it.
[[nodiscard]] MessageDamage read_bag(const std::string& file, const NamedBy& named_by,
                                     const std::function<void(const MessageChannel&)>& on_channel,
                                     const std::function<void(const TimedMessage&)>& on_message);

}  // namespace joulepath
