#include "extensions/nav2/commands/nav2_commands.hpp"

#include "app/program_parts.hpp"

namespace joulepath {

void add_nav2_commands(ProgramParts& parts) {
  parts.export_tasks.push_back(make_route_graph_task);
  parts.comparisons.push_back(make_settings_comparison);
}

}  // namespace joulepath
