#pragma once

#include <optional>
#include <string>

#include "planner/path/floor/occupancy_grid.hpp"

namespace joulepath {

OccupancyGrid free_grid(int width, int height, double resolution_m);
/// Each cell occupied with a probability.
OccupancyGrid random_grid(int width, int height, double resolution_m, double occupied_share, unsigned seed);
/// 60 x 40 m at 5 cm (or of another size): shelf rows with aisles, cross aisles and stray pallets.
OccupancyGrid warehouse_grid(unsigned seed, double length_m = 60, double depth_m = 40,
                             double resolution_m = 0.05);
/// A binary PGM of a trinary Nav2 map (dark: occupied, light: free, between: unknown), read independently of
/// the product's reader; absent if the file is.
std::optional<OccupancyGrid> pgm_grid(const std::string& file, double resolution_m, const Pose& origin);
std::optional<OccupancyGrid> nav2_warehouse();
std::optional<OccupancyGrid> nav2_warehouse_keepout();
std::optional<OccupancyGrid> nav2_depot();

}  // namespace joulepath
