#include "extensions/studio/commands/studio_commands.hpp"

#include "app/program_parts.hpp"

namespace joulepath {

void add_studio_commands(ProgramParts& parts) { parts.add(make_studio_command); }

}  // namespace joulepath
