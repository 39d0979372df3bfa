#pragma once

#include "extensions/bags/mcap_file.hpp"

namespace joulepath {

/// Reads a file of rosbag2's sqlite3 storage in the order of its times. SQL of the file never runs, and work
/// is bounded by the size of the file. Definitions are in the files since ROS 2 Iron. Throws ConfigError if
/// the file cannot be read, is not such a bag, or has views in place of tables.
[[nodiscard]] MessageDamage read_sqlite_bag(const std::string& file, const NamedBy& named_by,
                                            const std::function<void(const MessageChannel&)>& on_channel,
                                            const std::function<void(const TimedMessage&)>& on_message);

}  // namespace joulepath
