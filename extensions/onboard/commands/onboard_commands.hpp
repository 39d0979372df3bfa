#pragma once

#include <memory>

#include "app/command.hpp"

namespace joulepath {

[[nodiscard]] std::unique_ptr<Command> make_follow_command();
[[nodiscard]] std::unique_ptr<Command> make_monitor_command();
[[nodiscard]] std::unique_ptr<Command> make_drift_command();

}  // namespace joulepath
