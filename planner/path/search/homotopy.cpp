#include "planner/path/search/homotopy.hpp"

#include <cmath>

namespace joulepath {
namespace {

using Cell = OccupancyGrid::CellIndex;

/// Crossings of the ray from p along +x by a polyline, counted with sign: half of a winding number's terms.
int signed_crossings(const std::vector<Point2>& line, const Point2& p) {
  int count = 0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Point2 &a = line[i], &b = line[i + 1];
    const bool a_above = a[1] > p[1], b_above = b[1] > p[1];
    if (a_above == b_above) continue;
    const double x = a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
    if (x > p[0]) count += b_above ? 1 : -1;
  }
  return count;
}

}  // namespace

std::vector<Point2> island_points(const FreeSpace& space) {
  const OccupancyGrid& grid = space.grid();
  const auto at = [&](Cell cell) { return grid.index_of(cell); };
  std::vector<std::uint8_t> seen(grid.cell_count(), 0);
  std::vector<Point2> points;
  std::vector<Cell> open;
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const Cell first{column, row};
      if (seen[at(first)] != 0 || space.free_cell(first)) continue;
      bool touches_rim = false;
      seen[at(first)] = 1;
      open.push_back(first);
      while (!open.empty()) {
        const Cell cell = open.back();
        open.pop_back();
        // Free cells are connected over corners, so blocked cells are connected over sides only.
        for (const Cell& next : {Cell{cell.column + 1, cell.row}, Cell{cell.column - 1, cell.row},
                                 Cell{cell.column, cell.row + 1}, Cell{cell.column, cell.row - 1}}) {
          if (!grid.contains(next)) {
            touches_rim = true;
          } else if (seen[at(next)] == 0 && !space.free_cell(next)) {
            seen[at(next)] = 1;
            open.push_back(next);
          }
        }
      }
      if (!touches_rim) points.push_back(grid.center_of(first));
    }
  return points;
}

bool same_homotopy_class(const std::vector<Point2>& a_m, const std::vector<Point2>& b_m,
                         const std::vector<Point2>& islands_m) {
  for (const Point2& island : islands_m)
    if (signed_crossings(a_m, island) != signed_crossings(b_m, island)) return false;
  return true;
}

}  // namespace joulepath
