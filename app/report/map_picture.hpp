#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "planner/path/floor/occupancy_grid.hpp"

namespace joulepath::report {

/// A map for a report: cells as run lengths, row-major from the bottom row up.
struct MapPicture {
  enum Cell { free = 0, unknown = 1, occupied = 2, keep_out = 3 };
  int width{};
  int height{};
  double resolution_m{};
  Pose origin{};
  std::vector<std::pair<Cell, int>> runs{};
};

/// A grid with the cells forbidden by a keep-out mask, coarsened to at most `most_cells` cells; a block with
/// an occupied cell is occupied.
[[nodiscard]] MapPicture map_picture(const OccupancyGrid& grid, const OccupancyGrid* keep_out = nullptr,
                                     std::size_t most_cells = 600'000);

}  // namespace joulepath::report
