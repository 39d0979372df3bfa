#pragma once

#include <functional>
#include <string>

#include "planner/values/mission_request.hpp"
#include "scenarios/registry.hpp"

namespace joulepath {

[[nodiscard]] Schema mission_schema();

/// Reads a mission file. Names of stations and legs are checked; its files are resolved but not read.
[[nodiscard]] MissionRequest read_mission(const std::string& file, const ReadOptions& options = {});

/// The mission of a parsed document; a line of JSON lines becomes a document with its own first line.
[[nodiscard]] MissionRequest mission_from(const Document& document, const ReadOptions& options = {});

/// The reader of a document that stands for a mission; null: it is none.
[[nodiscard]] const MissionDocument* mission_document_of(const Document& document);

/// Reads the files that a mission names; a given robot replaces the mission's file. Throws ConfigError at the
/// key of an invalid file.
[[nodiscard]] MissionWorld read_world(const MissionRequest& request, const ReadOptions& options = {},
                                      const Robot* robot = nullptr);

/// read_world() without its checks of the robot against the mission: for many missions with the same files.
[[nodiscard]] MissionWorld read_named_files(const MissionRequest& request, const ReadOptions& options = {},
                                            const Robot* robot = nullptr);

/// Without an outline, nothing can be checked against a map. Throws ConfigError.
void check_footprint(const MissionRequest& request, const Robot& robot);

/// Throws ConfigError, named by `named_by`, if the robot may not carry the payload.
void check_payload(double payload_kg, const Robot& robot, const std::string& robot_file,
                   const NamedBy& named_by);

/// Calls `visit` for all files that the plan of a mission depends on, except the mission's own: robot, order,
/// route graph, and maps with their images. Throws ConfigError if a map file cannot be read, after its visit.
void visit_files_read_by(const MissionRequest& request, const ReadOptions& options,
                         const std::function<void(const std::string&)>& visit);

/// The marks of a map in the file and of its keys.
[[nodiscard]] ItemMarks marks_of(const Node& node);

}  // namespace joulepath
