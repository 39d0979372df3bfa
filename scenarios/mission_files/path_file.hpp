#pragma once

#include <optional>
#include <string>

#include "planner/path/shape/waypoint_path.hpp"
#include "scenarios/text/schema.hpp"

namespace joulepath {

/// `schema: joulepath/path/1`: a chain of cubic Bezier curves in the map frame, or a file of waypoints.
[[nodiscard]] Schema path_schema();

/// Whether a document is a path: by its schema line, by `bezier_m` or `waypoints` at its top, or as a list of
/// poses (nav_msgs/Path, PoseArray, the exports nav2_path and trajectory).
[[nodiscard]] bool is_path(const Document& document);

/// Whether a file is read as waypoints: by its extension, `.csv`.
[[nodiscard]] bool is_waypoint_file(const std::string& file);

/// Whether a CSV file holds waypoints, not a run log: by its column x_m and no time_s.
[[nodiscard]] bool has_waypoints(const std::string& file);

/// The path of a document. It begins with the heading of its first curve; at a heading step the robot turns
/// in place. `notes` gets the joints with a stop or a turn, and what read_waypoints() notes; `tolerance_m`
/// replaces that of the document. Throws ConfigError at a curve that cannot be driven.
[[nodiscard]] Path path_from(const Document& document, const ReadOptions& options = {},
                             std::vector<std::string>* notes = nullptr,
                             std::optional<double> tolerance_m = {});

/// Reads waypoints (CSV: x_m, y_m): one curve with continuous curvature along them (curve_through), with a
/// column heading_rad a path along poses (path_along_poses), or, with a column corner_radius_m, straight
/// lines whose corners are rounded with that smallest radius (0 or empty: turn in place). A file that is not
/// CSV is read as a list of poses. Throws ConfigError at a row that cannot be driven.
///
/// Without a tolerance it is kWaypointTolerance_m; where the curve then bends more closely than the points
/// are apart, as along the steps of a grid, it fits the spacing, and `notes` says so.
[[nodiscard]] Path read_waypoints(const std::string& file, std::optional<double> tolerance_m = {},
                                  const NamedBy& named_by = {}, std::vector<std::string>* notes = nullptr);

}  // namespace joulepath
