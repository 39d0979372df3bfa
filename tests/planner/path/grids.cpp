#include "tests/planner/path/grids.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <random>

#include "tests/support/locations.hpp"

namespace joulepath {
namespace {

void fill(OccupancyGrid& grid, double x0_m, double y0_m, double x1_m, double y1_m) {
  const auto from = grid.cell_of(x0_m, y0_m), to = grid.cell_of(x1_m, y1_m);
  for (int row = std::max(0, from.row); row < std::min(grid.height, to.row); ++row)
    for (int column = std::max(0, from.column); column < std::min(grid.width, to.column); ++column)
      grid.occupancy_percent[static_cast<std::size_t>(row * grid.width + column)] = 100;
}

}  // namespace

OccupancyGrid free_grid(int width, int height, double resolution_m) {
  OccupancyGrid grid;
  grid.width = width;
  grid.height = height;
  grid.resolution_m = resolution_m;
  grid.occupancy_percent.assign(static_cast<std::size_t>(width * height), 0);
  return grid;
}

OccupancyGrid random_grid(int width, int height, double resolution_m, double occupied_share, unsigned seed) {
  OccupancyGrid grid = free_grid(width, height, resolution_m);
  std::mt19937 random(seed);
  for (auto& cell : grid.occupancy_percent)
    if (static_cast<double>(random()) < occupied_share * 4294967296.0) cell = 100;
  return grid;
}

OccupancyGrid warehouse_grid(unsigned seed, double length_m, double depth_m, double resolution_m) {
  OccupancyGrid grid = free_grid(static_cast<int>(length_m / resolution_m),
                                 static_cast<int>(depth_m / resolution_m), resolution_m);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  for (double y = 3; y + 1.2 < depth_m - 2; y += 3.0)
    for (double x = 3; x + 8 < length_m - 2; x += 10.5) fill(grid, x, y, x + 8, y + 1.2);
  for (int i = 0; i < 40; ++i) {
    const double x = length_m * unit(random), y = depth_m * unit(random);
    fill(grid, x, y, x + 0.3 + 0.5 * unit(random), y + 0.3 + 0.5 * unit(random));
  }
  return grid;
}

std::optional<OccupancyGrid> pgm_grid(const std::string& file, double resolution_m, const Pose& origin) {
  std::ifstream in(file, std::ios::binary);
  std::string magic;
  if (!(in >> magic) || magic != "P5") return std::nullopt;
  int numbers[3];
  for (int& number : numbers) {
    while ((in >> std::ws).peek() == '#') in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    in >> number;
  }
  in.get();
  OccupancyGrid grid = free_grid(numbers[0], numbers[1], resolution_m);
  grid.origin = origin;
  for (int row = grid.height - 1; row >= 0; --row)
    for (int column = 0; column < grid.width; ++column) {
      const double occupied = 1 - static_cast<double>(in.get()) / numbers[2];
      grid.occupancy_percent[static_cast<std::size_t>(row * grid.width + column)] = occupied > 0.65 ? 100
                                                                                    : occupied < 0.25
                                                                                        ? 0
                                                                                        : kUnknownCell;
    }
  return grid;
}

namespace {

std::optional<OccupancyGrid> nav2_map(const std::string& name, double resolution_m, const Pose& origin) {
  return pgm_grid(JOULEPATH_SOURCE_DIR "/scenarios/maps/" + name, resolution_m, origin);
}

}  // namespace

std::optional<OccupancyGrid> nav2_warehouse() { return nav2_map("warehouse.pgm", 0.03, {-15.1, -25, 0}); }
std::optional<OccupancyGrid> nav2_warehouse_keepout() {
  return nav2_map("warehouse_keepout.pgm", 0.03, {-15.1, -25, 0});
}
std::optional<OccupancyGrid> nav2_depot() { return nav2_map("depot.pgm", 0.05, {0, 0, 0}); }

}  // namespace joulepath
