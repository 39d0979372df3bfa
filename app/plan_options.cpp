#include "app/plan_options.hpp"

#include <CLI/CLI.hpp>

namespace joulepath {

void add_plan_options(CLI::App& app, PlanOptions& options, const std::string& nodes_say) {
  app.add_option("--nodes", options.nodes, nodes_say)->check(CLI::Range(10, 20000))->capture_default_str();
  app.add_option("--seed", options.seed, "seed of the path search")->capture_default_str();
}

}  // namespace joulepath
