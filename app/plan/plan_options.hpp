#pragma once

#include <optional>
#include <string>

#include "planner/legs/stretch.hpp"
#include "scenarios/mission_files/mission_source.hpp"

namespace joulepath {

class CommandLine;

/// Adds --nodes and --seed, which every command that plans a mission takes.
void add_plan_options(CommandLine& line, PlanOptions& options,
                      const std::string& nodes_say = "nodes of the first grid on each stretch");

/// Adds --confidence, which replaces the mission's.
void add_confidence(CommandLine& line, std::optional<double>& confidence);

/// Adds the options for the input: the file, --robot, --map, and for a path --payload and (`with_time`)
/// --time.
void add_mission_source(CommandLine& line, MissionSource& source, bool with_time = true);

/// Reads the input and, unless `quiet`, tells what its reader noted.
[[nodiscard]] MissionRequest read_told_source(const MissionSource& source, const ReadOptions& options,
                                              bool quiet);

/// Reads the mission's files and, unless `quiet`, tells what is doubtful in them.
[[nodiscard]] MissionWorld read_told_world(const MissionRequest& mission, const ReadOptions& options,
                                           bool quiet);

}  // namespace joulepath
