#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/trajectory.hpp"

namespace joulepath {

inline constexpr std::int8_t kUnknownCell = -1;

/// A map in Nav2's format: one value per cell, 0 (free) to 100 (occupied) or kUnknownCell, row-major
/// from the bottom row; `origin` is the pose of the bottom-left corner of the bottom-left cell.
struct OccupancyGrid {
  int width{};
  int height{};
  double resolution_m{};
  Pose origin{};
  std::vector<std::int8_t> occupancy_percent{};
  std::string file{};  ///< for messages

  struct CellIndex {
    int column{};
    int row{};
  };

  [[nodiscard]] bool contains(CellIndex cell) const {
    return cell.column >= 0 && cell.row >= 0 && cell.column < width && cell.row < height;
  }
  [[nodiscard]] std::size_t cell_count() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  /// Place of a cell, row by row.
  [[nodiscard]] std::size_t index_of(CellIndex cell) const {
    return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(cell.column);
  }
  [[nodiscard]] CellIndex cell_at(std::size_t index) const {
    const auto columns = static_cast<std::size_t>(width);
    return {static_cast<int>(index % columns), static_cast<int>(index / columns)};
  }
  [[nodiscard]] std::int8_t at(CellIndex cell) const { return occupancy_percent[index_of(cell)]; }
  /// The cell that holds a point of the map frame; it may lie outside of the grid.
  [[nodiscard]] CellIndex cell_of(double x_m, double y_m) const {
    const double c = std::cos(origin.heading_rad), s = std::sin(origin.heading_rad);
    const double dx_m = x_m - origin.x_m, dy_m = y_m - origin.y_m;
    return {static_cast<int>(std::floor((c * dx_m + s * dy_m) / resolution_m)),
            static_cast<int>(std::floor((-s * dx_m + c * dy_m) / resolution_m))};
  }
  /// Center of a cell in the map frame.
  [[nodiscard]] std::array<double, 2> center_of(CellIndex cell) const {
    return center_of(cell, std::cos(origin.heading_rad), std::sin(origin.heading_rad));
  }
  /// With the cosine and sine of the grid's heading, for callers that ask for many cells.
  [[nodiscard]] std::array<double, 2> center_of(CellIndex cell, double cosine, double sine) const {
    const double u_m = (cell.column + 0.5) * resolution_m, v_m = (cell.row + 0.5) * resolution_m;
    return {origin.x_m + cosine * u_m - sine * v_m, origin.y_m + sine * u_m + cosine * v_m};
  }
};

/// Nav2 speed mask: a cell of value v (1..100) caps the speed at base + multiplier v, in percent of the
/// robot's limit or in m/s; 0 and unknown mean no cap.
struct SpeedMask {
  enum class Kind { percent, absolute };
  OccupancyGrid grid{};
  Kind kind{Kind::percent};
  double base{100.0};
  double multiplier{-1.0};

  /// Speed cap at a point, m/s; absent if the mask sets none.
  [[nodiscard]] std::optional<double> speed_cap_m_s(double x_m, double y_m, double limit_m_s) const {
    const auto cell = grid.cell_of(x_m, y_m);
    if (!grid.contains(cell)) return std::nullopt;
    const int value = grid.at(cell);
    if (value <= 0) return std::nullopt;
    const double setting = base + multiplier * value;
    return kind == Kind::percent ? limit_m_s * setting / 100.0 : setting;
  }
};

}  // namespace joulepath
