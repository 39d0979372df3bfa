#pragma once

#include <memory>

#include "app/export_task.hpp"
#include "app/plan/plan_comparison.hpp"

namespace joulepath {

[[nodiscard]] std::unique_ptr<ExportTask> make_route_graph_task();
[[nodiscard]] std::unique_ptr<PlanComparison> make_settings_comparison();

}  // namespace joulepath
