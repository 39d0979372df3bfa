#include "app/plan_options.hpp"

#include <CLI/CLI.hpp>

namespace joulepath {

void add_plan_options(CLI::App& app, PlanOptions& options, const std::string& nodes_say) {
  app.add_option("--nodes", options.nodes, nodes_say)->check(CLI::Range(10, 20000))->capture_default_str();
  app.add_option("--seed", options.seed, "seed of the path search")->capture_default_str();
}

void add_mission_source(CLI::App& app, MissionSource& source, bool with_time) {
  app.add_option("mission", source.file,
                 "mission (YAML); or a VDA 5050 order (JSON) or a path (YAML, CSV), with --robot")
      ->required();
  app.add_option("--robot", source.robot_file, "robot file in place of the mission's");
  app.add_option("--map", source.map_file, "map in place of the mission's");
  app.add_option("--payload", source.payload_kg, "kg on board along a path; default 0")
      ->check(CLI::NonNegativeNumber);
  if (with_time)
    app.add_option("--time", source.duration_s, "seconds for a path; default: where the energy is least")
        ->check(CLI::PositiveNumber);
}

}  // namespace joulepath
