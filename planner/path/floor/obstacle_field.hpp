#pragma once

#include <cstdint>
#include <vector>

#include "planner/path/floor/occupancy_grid.hpp"

namespace joulepath {

/// Percent and above: an obstacle, and so is an unknown cell of the map.
inline constexpr int kBlockedFromPercent = 65;

/// Distances from points of the floor to obstacles. Obstacles are whole cells (squares) of a map that are
/// occupied or unknown, everything outside of the map, and occupied cells of a keep-out mask.
///
/// Built once per map (a Euclidean distance transform each), then read by all legs and robots; read-only
/// and safe to share between threads.
class ObstacleField {
 public:
  explicit ObstacleField(const OccupancyGrid& map, const OccupancyGrid* keepout = nullptr);

  enum class Layer { map, keepout };
  /// The obstacle nearest to a point.
  struct Nearest {
    double distance_m{};  ///< to the cell's square, 0 inside of it
    Layer layer{};
    double x_m{};  ///< nearest point of the obstacle
    double y_m{};
  };

  /// Bounds of the distance at a point, from the transform alone (a few nanoseconds): no farther apart
  /// than a cell's diagonal.
  struct Bounds {
    double lower_m{};
    double upper_m{};
  };
  [[nodiscard]] Bounds distance_bounds_m(double x_m, double y_m) const;
  /// Exact distance to the nearest obstacle.
  [[nodiscard]] double distance_m(double x_m, double y_m) const;
  [[nodiscard]] Nearest nearest(double x_m, double y_m) const;
  /// Whether a disc about a point is free: exact, and fast away from its limit.
  [[nodiscard]] bool disc_free(double x_m, double y_m, double radius_m) const;

  /// Calls visit(center_x_m, center_y_m, half_side_m, heading_rad) for the squares of all blocked cells
  /// whose centers lie within a distance of a point; stops when it returns false.
  template <class Visit>
  bool for_blocked_cells(double x_m, double y_m, double within_m, const Visit& visit) const;

  const OccupancyGrid& map() const { return layers_.front().grid; }
  /// The rectangle around the map, in the map frame.
  struct Extent {
    double x_min_m{}, x_max_m{}, y_min_m{}, y_max_m{};
  };
  [[nodiscard]] Extent extent_m() const;

 private:
  struct LayerField {
    OccupancyGrid grid{};  ///< geometry; occupancy is moved to `blocked`
    std::vector<std::uint8_t> blocked{};
    std::vector<float> distance_cells{};  ///< from a cell's center to the nearest blocked square
    double cosine{}, sine{};
    bool outside_blocked{};

    struct Local {
      double u{}, v{};  ///< in cells, in the grid's frame
    };
    Local local(double x_m, double y_m) const;
    Bounds bounds(double x_m, double y_m) const;
    bool nearest(double x_m, double y_m, double upper_m, Nearest& best) const;
  };
  static LayerField layer(const OccupancyGrid& grid, bool is_map);

  std::vector<LayerField> layers_{};
};

template <class Visit>
bool ObstacleField::for_blocked_cells(double x_m, double y_m, double within_m, const Visit& visit) const {
  for (const LayerField& field : layers_) {
    const auto [u, v] = field.local(x_m, y_m);
    const OccupancyGrid& grid = field.grid;
    const double reach = within_m / grid.resolution_m, side_m = grid.resolution_m;
    // One ring of cells around the map stands for everything outside of it.
    const int rim = field.outside_blocked ? static_cast<int>(reach) + 2 : 0;
    const auto first = [&](double w) { return std::max(-rim, static_cast<int>(std::floor(w - reach))); };
    const auto last = [&](double w, int n) {
      return std::min(n - 1 + rim, static_cast<int>(std::floor(w + reach)));
    };
    for (int row = first(v); row <= last(v, grid.height); ++row)
      for (int column = first(u); column <= last(u, grid.width); ++column) {
        const OccupancyGrid::CellIndex cell{column, row};
        const bool inside = grid.contains(cell);
        if (inside && field.blocked[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.width) +
                                    static_cast<std::size_t>(column)] == 0)
          continue;
        const double du = column + 0.5 - u, dv = row + 0.5 - v;
        if (du * du + dv * dv > reach * reach) continue;
        const auto center = grid.center_of(cell);
        if (!visit(center[0], center[1], 0.5 * side_m, grid.origin.heading_rad)) return false;
      }
  }
  return true;
}

}  // namespace joulepath
