#include "app/plan/plan_options.hpp"

#include <iostream>

#include "app/command_line.hpp"
#include "model/printable.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/mission_files/world_notes.hpp"
#include "scenarios/registry.hpp"

namespace joulepath {
namespace {

void tell_notes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) std::cerr << "note: " << printable(note) << "\n";
}

}  // namespace

void add_plan_options(CommandLine& line, PlanOptions& options, const std::string& nodes_say) {
  line.option("--nodes", options.nodes, nodes_say).between(10, 20000).shows_default();
  line.option("--seed", options.seed, "seed of the path search").shows_default();
}

void add_confidence(CommandLine& line, std::optional<double>& confidence) {
  line.option("--confidence", confidence,
              "probability with which deadlines, battery reserve and limits of motors and tires are kept "
              "together, by the robot file's uncertainty")
      .between(kLeastConfidence, kGreatestConfidence);
}

void add_mission_source(CommandLine& line, MissionSource& source, bool with_time) {
  std::string others;
  for (const MissionDocument& document : registry().mission_documents)
    others += document.says + " (JSON) or ";
  line.option("mission", source.file, "mission (YAML); or " + others + "a path (YAML, CSV), with --robot")
      .required();
  line.option("--robot", source.robot_file, "robot file; replaces the mission's");
  line.option("--map", source.map_file, "map; replaces the mission's");
  line.option("--payload", source.payload_kg, "kg on board along a path; default 0").not_negative();
  if (with_time)
    line.option("--time", source.duration_s,
                "duration for a path in seconds; default: the duration of least energy")
        .positive();
  line.option("--tolerance", source.tolerance_m,
              "how far a path may be from its points, m; default 0.01, or 0.6 of their spacing along the "
              "steps of a grid")
      .not_negative();
}

MissionRequest read_told_source(const MissionSource& source, const ReadOptions& options, bool quiet) {
  std::vector<std::string> notes;
  MissionRequest mission = read_mission_source(source, options, &notes);
  if (!quiet) tell_notes(notes);
  return mission;
}

MissionWorld read_told_world(const MissionRequest& mission, const ReadOptions& options, bool quiet) {
  MissionWorld world = read_world(mission, options);
  if (!quiet) tell_notes(world_notes(mission, world, options));
  return world;
}

}  // namespace joulepath
