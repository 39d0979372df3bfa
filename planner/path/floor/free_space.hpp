#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "planner/path/floor/obstacle_field.hpp"
#include "planner/path/geometry/polygon_distance.hpp"
// Design: docs/decisions/0201-routes-and-floor.md

namespace joulepath {

/// The floor for a disc of one radius, cell by cell: which cells are free, and which of them are connected
/// (8-neighbors). It decides quickly whether a search can succeed, and checks lines by cell look-ups. Built
/// once per map and radius.
class FreeSpace {
 public:
  FreeSpace(const ObstacleField& field, double radius_m, double largest_cell_m = kLargestCell_m);

  const ObstacleField& field() const { return *field_; }
  double radius_m() const { return radius_m_; }
  /// Geometry of the cells: the map's, divided where they are larger than that, as long as the floor has at
  /// most kMostCells then.
  const OccupancyGrid& grid() const { return grid_; }
  /// Component at a point: that of its cell, or of a free neighbor cell; absent if there is none.
  [[nodiscard]] std::optional<int> component(const Point2& point_m) const;
  [[nodiscard]] bool connected(const Point2& a_m, const Point2& b_m) const;
  /// The place nearest to `goal` that can be reached from `start`; absent if `start` has no component.
  [[nodiscard]] std::optional<Point2> nearest_reachable(const Point2& start_m, const Point2& goal_m) const;

  /// The center of a free cell nearest to a point, of one component or of any, where `fits` holds; absent if
  /// there is none.
  [[nodiscard]] std::optional<Point2> nearest_free(const Point2& point_m, std::optional<int> component,
                                                   const std::function<bool(const Point2&)>& fits) const;

  /// Cells that a way may use.
  enum class Cells {
    free,  ///< the disc is free at the cell's center
    clear  ///< it is free at every point of the cell, with 5 mm to spare
  };
  /// A way over cell centers, shortest by octile distance (A*); empty if there is none. Free cells within
  /// kNearEnds_m of the ends may always be used.
  [[nodiscard]] std::vector<Point2> cell_route(const Point2& start_m, const Point2& goal_m,
                                               Cells cells) const;
  /// Octile length of the shortest way over free cells from each cell to a goal; infinite where there is
  /// none.
  [[nodiscard]] std::vector<float> lengths_to_m(const Point2& goal_m) const;
  [[nodiscard]] bool clear(double x_m, double y_m) const { return rings(grid_.cell_of(x_m, y_m)) != 0; }
  /// 0 where a cell is not clear, else one more than the rings of cells about it that are clear as well (at
  /// most 254).
  [[nodiscard]] int rings(OccupancyGrid::CellIndex cell) const {
    return grid_.contains(cell) ? rings_[index(cell)] : 0;
  }
  [[nodiscard]] bool free_cell(OccupancyGrid::CellIndex cell) const { return component_[index(cell)] >= 0; }
  /// Calls visit(cell) for the cells on a line that are not clear until it returns false.
  template <class Visit>
  bool for_unclear_cells_on_line(const Point2& a_m, const Point2& b_m, const Visit& visit) const;

  static constexpr double kNearEnds_m = 0.8;
  static constexpr double kSpare_m = 0.005;      ///< distance that a line keeps beyond the clearance
  static constexpr double kLeastSpare_m = 1e-4;  ///< the same where no line keeps kSpare_m
  static constexpr double kLargestCell_m = 0.05, kSmallestCell_m = 0.0125;
  static constexpr double kMostCells = 4e6;

 private:
  std::optional<OccupancyGrid::CellIndex> free_cell_near(const Point2& point_m) const;
  std::size_t index(OccupancyGrid::CellIndex cell) const { return grid_.index_of(cell); }
  void count_rings();

  const ObstacleField* field_{};
  OccupancyGrid grid_{};  ///< geometry only
  double radius_m_{};
  std::vector<std::int32_t> component_{};  ///< -1: not free
  std::vector<std::uint8_t> rings_{};
  double cosine_{}, sine_{};  ///< of the grid's heading
};

/// Whether a disc may move along lines between two ends. Either quick and slightly conservative (clear cells
/// only, exact near the ends), or exact everywhere for floors that are too narrow for that. The space must
/// outlive it.
class DiscLineCheck {
 public:
  DiscLineCheck(const FreeSpace& space, const Point2& start_m, const Point2& goal_m, FreeSpace::Cells cells,
                double spare_m = FreeSpace::kSpare_m);

  [[nodiscard]] bool operator()(const Point2& a_m, const Point2& b_m) const;
  [[nodiscard]] bool point_free(const Point2& p_m) const;

 private:
  bool near_ends(const Point2& p_m) const;
  bool is_end(const Point2& p_m) const { return p_m == start_m_ || p_m == goal_m_; }

  const FreeSpace* space_{};
  Point2 start_m_{}, goal_m_{};
  FreeSpace::Cells cells_{};
  double exact_radius_m_{};
};

template <class Visit>
bool FreeSpace::for_unclear_cells_on_line(const Point2& a_m, const Point2& b_m, const Visit& visit) const {
  // Traversal of a grid from cell side to cell side, in the grid's own frame. `next`, `stride` and `at` are
  // shares of the line.
  const double c = cosine_, s = sine_;
  const auto local = [&](const Point2& p) -> Point2 {
    const double dx = (p[0] - grid_.origin.x_m) / grid_.resolution_m,
                 dy = (p[1] - grid_.origin.y_m) / grid_.resolution_m;
    return {c * dx + s * dy, c * dy - s * dx};
  };
  const Point2 from = local(a_m), to = local(b_m);
  int cell[2], last[2], step[2];
  double next[2], stride[2];
  for (std::size_t i = 0; i < 2; ++i) {
    const double d = to[i] - from[i];
    cell[i] = static_cast<int>(std::floor(from[i]));
    last[i] = static_cast<int>(std::floor(to[i]));
    step[i] = d > 0 ? 1 : -1;
    stride[i] = d != 0 ? std::abs(1 / d) : std::numeric_limits<double>::infinity();
    next[i] = d != 0 ? (d > 0 ? cell[i] + 1 - from[i] : from[i] - cell[i]) * stride[i] : stride[i];
  }
  const double most = std::max(std::abs(to[0] - from[0]), std::abs(to[1] - from[1]));
  double at = 0;
  int left = std::abs(last[0] - cell[0]) + std::abs(last[1] - cell[1]);
  while (left >= 0) {
    const OccupancyGrid::CellIndex here{cell[0], cell[1]};
    const int rings = grid_.contains(here) ? rings_[index(here)] : 0;
    if (rings == 0 && !visit(here)) return false;
    if (rings < 3) {
      const std::size_t axis = next[0] < next[1] ? 0 : 1;
      at = next[axis];
      cell[axis] += step[axis];
      next[axis] += stride[axis];
      --left;
      continue;
    }
    // A cell that the line crosses within rings - 2 cells of this place is in the clear rings.
    at += (rings - 2) / most;
    if (at >= 1) return true;
    for (std::size_t i = 0; i < 2; ++i) {
      if (!(next[i] <= at)) continue;
      const double crossed = std::floor((at - next[i]) / stride[i]) + 1;
      cell[i] += static_cast<int>(crossed) * step[i];
      next[i] += crossed * stride[i];
      left -= static_cast<int>(crossed);
    }
  }
  return true;
}

}  // namespace joulepath
