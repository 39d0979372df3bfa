#include "extensions/onboard/commands/onboard_commands.hpp"

#include "app/program_parts.hpp"

namespace joulepath {

void add_onboard_commands(ProgramParts& parts) {
  parts.add(make_follow_command);
  parts.add(make_monitor_command);
  parts.add(make_drift_command);
}

}  // namespace joulepath
