#pragma once

#include <string>

#include "planner/values/mission_request.hpp"
#include "scenarios/schema.hpp"

namespace joulepath {

[[nodiscard]] Schema mission_schema();

/// Reads a mission file; names of stations and legs are checked, files that it names are resolved but not
/// read.
[[nodiscard]] MissionRequest read_mission(const std::string& file, const ReadOptions& options = {});

/// The mission of a parsed document; a line of JSON lines becomes a document with its own first line.
[[nodiscard]] MissionRequest mission_from(const Document& document, const ReadOptions& options = {});

/// Reads the files that a mission names; a robot that is given is taken in place of the mission's file.
/// Throws ConfigError at the key that names a broken one.
[[nodiscard]] MissionWorld read_world(const MissionRequest& request, const ReadOptions& options = {},
                                      const Robot* robot = nullptr);

/// Every file beside the mission's own that its plan depends on: robot, order, route graph, and maps with
/// their images. Throws ConfigError where a map file cannot be read.
[[nodiscard]] std::vector<std::string> files_read_by(const MissionRequest& request,
                                                     const ReadOptions& options = {});

/// Where a map of the file and each of its keys stand.
[[nodiscard]] ItemMarks marks_of(const Node& node);

/// Reads a Nav2 route graph (GeoJSON: points with `id`, lines with `id`, `startid`, `endid`).
[[nodiscard]] RouteGraph read_route_graph(const std::string& file, const NamedBy& named_by = {});

}  // namespace joulepath
