#include "app/report/map_picture.hpp"

#include <algorithm>

namespace joulepath::report {
namespace {

constexpr int kOccupiedFrom_percent = 65;

MapPicture::Cell class_of(int percent) {
  if (percent < 0) return MapPicture::unknown;
  return percent >= kOccupiedFrom_percent ? MapPicture::occupied : MapPicture::free;
}

/// The class of a block of cells: occupied if one of its cells is occupied.
MapPicture::Cell block_class(const OccupancyGrid& grid, int column, int row, int factor) {
  bool is_free = false;
  for (int r = row; r < std::min(grid.height, row + factor); ++r) {
    for (int c = column; c < std::min(grid.width, column + factor); ++c) {
      const auto cell = class_of(grid.at({c, r}));
      if (cell == MapPicture::occupied) return cell;
      is_free = is_free || cell == MapPicture::free;
    }
  }
  return is_free ? MapPicture::free : MapPicture::unknown;
}

bool is_kept_out(const OccupancyGrid& mask, const OccupancyGrid& grid, int column, int row) {
  const auto [x_m, y_m] = grid.center_of({column, row});
  const auto cell = mask.cell_of(x_m, y_m);
  return mask.contains(cell) && mask.at(cell) >= kOccupiedFrom_percent;
}

}  // namespace

MapPicture map_picture(const OccupancyGrid& grid, const OccupancyGrid* keep_out, std::size_t most_cells) {
  int factor = 1;
  const auto cells = [&](int f) {
    return static_cast<std::size_t>((grid.width + f - 1) / f) *
           static_cast<std::size_t>((grid.height + f - 1) / f);
  };
  while (cells(factor) > most_cells) ++factor;
  MapPicture picture{(grid.width + factor - 1) / factor,
                     (grid.height + factor - 1) / factor,
                     grid.resolution_m * factor,
                     grid.origin,
                     {}};
  for (int row = 0; row < grid.height; row += factor) {
    for (int column = 0; column < grid.width; column += factor) {
      auto cell = block_class(grid, column, row, factor);
      const int middle_column = std::min(grid.width - 1, column + factor / 2);
      const int middle_row = std::min(grid.height - 1, row + factor / 2);
      if (cell != MapPicture::occupied && keep_out && is_kept_out(*keep_out, grid, middle_column, middle_row))
        cell = MapPicture::keep_out;
      if (picture.runs.empty() || picture.runs.back().first != cell) picture.runs.emplace_back(cell, 0);
      ++picture.runs.back().second;
    }
  }
  return picture;
}

}  // namespace joulepath::report
