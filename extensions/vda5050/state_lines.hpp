#pragma once

#include <functional>
#include <string_view>

#include "scenarios/log_files/messages.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {

/// The type of the channels of state_lines.
inline constexpr std::string_view kStateType = "vda5050/State";

/// Whether a file holds VDA 5050 `state` messages, one JSON object per line: by its extension (.jsonl,
/// .ndjson) and the keys of its first line.
[[nodiscard]] bool is_state_lines(const std::string& file);

/// Reads such a file as a bag: one channel per robot, named by its serial number; the time of a message is
/// its timestamp. Other lines are counted as broken. Throws ConfigError if the file cannot be read.
[[nodiscard]] MessageDamage read_state_lines(const std::string& file, const NamedBy& named_by,
                                             const std::function<void(const MessageChannel&)>& on_channel,
                                             const std::function<void(const TimedMessage&)>& on_message);

}  // namespace joulepath
