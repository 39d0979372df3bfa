#include "app/program_parts.hpp"

namespace joulepath {

std::unique_ptr<ExportTask> make_route_graph_task();
std::unique_ptr<PlanComparison> make_settings_comparison();

void add_nav2_commands(ProgramParts& parts) {
  parts.export_tasks.push_back(make_route_graph_task);
  parts.comparisons.push_back(make_settings_comparison);
}

}  // namespace joulepath
