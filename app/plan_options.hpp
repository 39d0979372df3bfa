#pragma once

#include <string>

#include "planner/stretch.hpp"

namespace CLI {
class App;
}

namespace joulepath {

/// Adds --nodes and --seed, which every command that plans a mission takes.
void add_plan_options(CLI::App& app, PlanOptions& options,
                      const std::string& nodes_say = "nodes of the first grid on each stretch");

}  // namespace joulepath
