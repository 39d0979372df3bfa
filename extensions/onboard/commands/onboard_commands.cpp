#include "app/program_parts.hpp"

namespace joulepath {

std::unique_ptr<Command> make_follow_command();
std::unique_ptr<Command> make_monitor_command();
std::unique_ptr<Command> make_drift_command();

void add_onboard_commands(ProgramParts& parts) {
  parts.add(make_follow_command);
  parts.add(make_monitor_command);
  parts.add(make_drift_command);
}

}  // namespace joulepath
