#pragma once

#include "scenarios/bags/mcap_file.hpp"

namespace joulepath {

/// Whether a name is read as a bag: `.mcap`, `.db3`, a folder with rosbag2's metadata.yaml, or
/// VDA 5050 states (see is_state_lines).
[[nodiscard]] bool is_bag(const std::string& file);

/// Reads a bag of any kind; the files of a folder one after the other, as its metadata lists them. A topic is
/// one channel, however many writers and files it has. Throws ConfigError.
[[nodiscard]] BagDamage read_bag(const std::string& file, const NamedBy& named_by,
                                 const std::function<void(const BagChannel&)>& on_channel,
                                 const std::function<void(const BagMessage&)>& on_message);

}  // namespace joulepath
