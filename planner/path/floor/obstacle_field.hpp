#pragma once

#include <cstdint>
#include <vector>

#include "planner/path/floor/occupancy_grid.hpp"

namespace joulepath {

/// An obstacle has at least this occupancy (percent); an unknown cell of the map is one, too.
inline constexpr int kBlockedFromPercent = 65;

/// Distances from points of the floor to obstacles. Obstacles are whole cells (squares) of a map that are
/// occupied or unknown, everything outside of the map, and occupied cells of a keep-out mask.
///
/// Built once per map (a Euclidean distance transform each), then read by all legs and robots; read-only and
/// therefore safe to share between threads.
class ObstacleField {
 public:
  explicit ObstacleField(const OccupancyGrid& map, const OccupancyGrid* keepout = nullptr);

  enum class Layer { map, unknown, keepout, edge };  ///< unknown: cells of the map; edge: all outside of it
  /// The obstacle nearest to a point.
  struct Nearest {
    double distance_m{};  ///< to the cell's square, 0 inside of it
    Layer layer{};
    double x_m{};  ///< nearest point of the obstacle
    double y_m{};
  };

  /// Bounds of the distance at a point, from the transform alone (a few nanoseconds): they differ by at most
  /// a cell's diagonal.
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

  /// The square of a blocked cell; its axes are turned by heading_rad.
  struct BlockedCell {
    double x_m{};  ///< center
    double y_m{};
    double half_side_m{};
    double heading_rad{};
    Layer layer{};
  };
  /// The corners of blocked cells around which a shortest way can bend: floor on three of their four sides.
  /// `heading_rad` points away from the obstacle along the diagonal.
  [[nodiscard]] std::vector<Pose> convex_corners() const;

  enum class Cells {
    all,
    rim  ///< beside a cell that is not blocked: the nearest obstacle of any place on the floor is one of them
  };
  /// Calls visit(cell) for the blocked cells that may have a point within a distance of a place.
  template <class Visit>
  void for_blocked_cells(double x_m, double y_m, double within_m, Cells cells, const Visit& visit) const;

  const OccupancyGrid& map() const { return layers_.front().grid; }
  /// The rectangle around the map, in the map frame.
  struct Extent {
    double x_min_m{}, x_max_m{}, y_min_m{}, y_max_m{};
  };
  [[nodiscard]] Extent extent_m() const;

 private:
  struct LayerField {
    OccupancyGrid grid{};                 ///< geometry; occupancy is moved to `blocked`
    std::vector<std::uint8_t> blocked{};  ///< 0 for floor, kUnknown for unknown cells
    std::vector<std::uint8_t> rim{};      ///< 1 for blocked cells beside floor
    std::vector<float> distance_cells{};  ///< from a cell's center to the nearest blocked square
    double cosine{}, sine{};
    bool outside_blocked{};
    Layer layer{};

    static constexpr std::uint8_t kUnknown = 2;
    [[nodiscard]] Layer layer_at(std::size_t cell) const {
      return blocked[cell] == kUnknown ? Layer::unknown : layer;
    }
    struct Local {
      double u{}, v{};  ///< in cells, in the grid's frame
    };
    Local local(double x_m, double y_m) const;
    bool beside_floor(OccupancyGrid::CellIndex cell) const;
    Bounds bounds(double x_m, double y_m) const;
    void nearest(double x_m, double y_m, double upper_m, Nearest& best) const;
  };
  static LayerField layer_of(const OccupancyGrid& grid, Layer layer);

  std::vector<LayerField> layers_{};
};

/// The name of an obstacle in messages.
[[nodiscard]] inline const char* name_of(ObstacleField::Layer layer) {
  if (layer == ObstacleField::Layer::edge) return "the map's edge";
  if (layer == ObstacleField::Layer::unknown) return "an unknown cell of the map";
  return layer == ObstacleField::Layer::keepout ? "the keep-out area" : "the obstacle";
}

template <class Visit>
void ObstacleField::for_blocked_cells(double x_m, double y_m, double within_m, Cells cells,
                                      const Visit& visit) const {
  for (const LayerField& field : layers_) {
    const auto [u, v] = field.local(x_m, y_m);
    const OccupancyGrid& grid = field.grid;
    constexpr double kHalfDiagonal = 0.7071067811865476;  // of a cell, in cells
    const double reach = within_m / grid.resolution_m + kHalfDiagonal;
    const bool unbounded = field.outside_blocked;
    const auto first = [&](double w) {
      const int cell = static_cast<int>(std::floor(w - reach));
      return unbounded ? cell : std::max(0, cell);
    };
    const auto last = [&](double w, int n) {
      const int cell = static_cast<int>(std::floor(w + reach));
      return unbounded ? cell : std::min(n - 1, cell);
    };
    for (int row = first(v); row <= last(v, grid.height); ++row)
      for (int column = first(u); column <= last(u, grid.width); ++column) {
        const OccupancyGrid::CellIndex cell{column, row};
        const bool inside = grid.contains(cell);
        if (inside && (cells == Cells::rim ? field.rim : field.blocked)[grid.index_of(cell)] == 0) continue;
        if (!inside && cells == Cells::rim && !field.beside_floor(cell)) continue;
        const double du = column + 0.5 - u, dv = row + 0.5 - v;
        if (du * du + dv * dv > reach * reach) continue;
        const auto [x, y] = grid.center_of(cell, field.cosine, field.sine);
        visit(BlockedCell{x, y, 0.5 * grid.resolution_m, grid.origin.heading_rad,
                          inside ? field.layer_at(grid.index_of(cell)) : Layer::edge});
      }
  }
}

}  // namespace joulepath
