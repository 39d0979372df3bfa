#pragma once

#include <memory>
#include <vector>

#include "app/command.hpp"

namespace joulepath {

/// The commands, in the order of the help; each name has a function make_NAME_command().
#define JOULEPATH_COMMANDS(COMMAND) \
  COMMAND(init)                     \
  COMMAND(plan)                     \
  COMMAND(batch)                    \
  COMMAND(export)                   \
  COMMAND(simulate)                 \
  COMMAND(estimate)                 \
  COMMAND(diagnose)                 \
  COMMAND(experiment)               \
  COMMAND(effects)                  \
  COMMAND(compare)                  \
  COMMAND(front)                    \
  COMMAND(check)                    \
  COMMAND(calibrate)                \
  COMMAND(schema)                   \
  COMMAND(completion)

#define JOULEPATH_DECLARE(name) [[nodiscard]] std::unique_ptr<Command> make_##name##_command();
JOULEPATH_COMMANDS(JOULEPATH_DECLARE)
#undef JOULEPATH_DECLARE

[[nodiscard]] std::vector<std::unique_ptr<Command>> all_commands();

}  // namespace joulepath
