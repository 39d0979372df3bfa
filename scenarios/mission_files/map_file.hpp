#pragma once

#include <string>
#include <vector>

#include "planner/path/floor/occupancy_grid.hpp"
#include "scenarios/text/schema.hpp"

namespace joulepath {

inline constexpr double kCoarsestCell_m = 1.0;  ///< of a map: larger cells are doubted

[[nodiscard]] Schema map_schema();

/// Reads a Nav2 map: YAML and its image, with the rules of Nav2's map server. Throws ConfigError.
///
///   occupancy = 1 - shade (shade when negated); trinary: occupied above occupied_thresh, free below
///   free_thresh, unknown between; scale: linear between, transparent pixels unknown; raw: the pixel's value.
[[nodiscard]] OccupancyGrid read_map(const std::string& file, const NamedBy& named_by = {},
                                     const ReadOptions& options = {});

/// What a user of a map may not expect: keys that are not read, and free floor that a map saver wrote as
/// unknown. Throws ConfigError.
[[nodiscard]] std::vector<std::string> map_notes(const std::string& file, const ReadOptions& options = {});

/// Of these the ones that change a plan: cells larger than a robot, dark and light exchanged, unknown cells
/// as floor. Throws ConfigError.
[[nodiscard]] std::vector<std::string> map_doubts(const std::string& file, const ReadOptions& options = {});

/// The image that a map file names. Throws ConfigError.
[[nodiscard]] std::string map_image_file(const std::string& file, const ReadOptions& options = {});

}  // namespace joulepath
