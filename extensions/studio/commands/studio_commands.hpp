#pragma once

#include <memory>

#include "app/command.hpp"

namespace joulepath {

[[nodiscard]] std::unique_ptr<Command> make_studio_command();

}  // namespace joulepath
