#include "planner/path/floor/obstacle_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "model/assert.hpp"
#include "planner/path/floor/distance_transform.hpp"

namespace joulepath {
namespace {
constexpr double kRounding = 1e-4;  // cells; distances are stored as float

/// Without the call of a function that std::floor is on processors without SSE 4.1.
int floor_of(double x) {
  const int towards_0 = static_cast<int>(x);
  return towards_0 - (x < towards_0 ? 1 : 0);
}

}  // namespace
ObstacleField::ObstacleField(const OccupancyGrid& map, const OccupancyGrid* keepout) {
  layers_.push_back(layer_of(map, Layer::map));
  if (keepout != nullptr) layers_.push_back(layer_of(*keepout, Layer::keepout));
}

ObstacleField::LayerField ObstacleField::layer_of(const OccupancyGrid& grid, Layer layer) {
  const bool is_map = layer == Layer::map;
  JOULEPATH_ASSERT(grid.width > 0 && grid.height > 0 && grid.resolution_m > 0 &&
                       grid.occupancy_percent.size() == grid.cell_count(),
                   "an occupancy grid needs width * height cells");
  LayerField field;
  field.blocked.reserve(grid.occupancy_percent.size());
  for (const std::int8_t percent : grid.occupancy_percent)
    field.blocked.push_back(is_map && percent == kUnknownCell ? LayerField::kUnknown
                            : percent >= kBlockedFromPercent  ? 1
                                                              : 0);
  field.grid.width = grid.width;
  field.grid.height = grid.height;
  field.grid.resolution_m = grid.resolution_m;
  field.grid.origin = grid.origin;
  field.grid.file = grid.file;
  field.cosine = std::cos(grid.origin.heading_rad);
  field.sine = std::sin(grid.origin.heading_rad);
  field.outside_blocked = is_map;
  field.layer = layer;
  field.rim.assign(field.blocked.size(), 0);
  for (std::size_t i = 0; i < field.blocked.size(); ++i)
    field.rim[i] = field.blocked[i] != 0 && field.beside_floor(grid.cell_at(i)) ? 1 : 0;
  field.distance_cells = squared_distance_transform(field.blocked, grid.width, grid.height);
  for (float& squared : field.distance_cells) squared = std::sqrt(squared);
  return field;
}

bool ObstacleField::LayerField::beside_floor(OccupancyGrid::CellIndex cell) const {
  constexpr std::array<OccupancyGrid::CellIndex, 4> kBeside{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  return std::any_of(kBeside.begin(), kBeside.end(), [&](const OccupancyGrid::CellIndex& side) {
    const OccupancyGrid::CellIndex next{cell.column + side.column, cell.row + side.row};
    return grid.contains(next) ? blocked[grid.index_of(next)] == 0 : !outside_blocked;
  });
}

ObstacleField::LayerField::Local ObstacleField::LayerField::local(double x_m, double y_m) const {
  const double dx = (x_m - grid.origin.x_m) / grid.resolution_m,
               dy = (y_m - grid.origin.y_m) / grid.resolution_m;
  return {cosine * dx + sine * dy, cosine * dy - sine * dx};
}

ObstacleField::Bounds ObstacleField::LayerField::bounds(double x_m, double y_m) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto [u, v] = local(x_m, y_m);
  const int column = floor_of(u), row = floor_of(v);
  if (!grid.contains({column, row})) return outside_blocked ? Bounds{0, 0} : Bounds{0, kInfinity};
  const std::size_t index = grid.index_of({column, row});
  const double center_distance = distance_cells[index];
  const double du = u - column - 0.5, dv = v - row - 0.5, off_center = std::sqrt(du * du + dv * dv);
  const double edge = outside_blocked ? std::min({u, v, grid.width - u, grid.height - v}) : kInfinity;
  const double lower = std::max(0.0, std::min(center_distance - off_center - kRounding, edge));
  const double upper = blocked[index] != 0 ? 0.0 : std::min(center_distance + off_center + kRounding, edge);
  return {lower * grid.resolution_m, upper * grid.resolution_m};
}

void ObstacleField::LayerField::nearest(double x_m, double y_m, double upper_m, Nearest& best) const {
  const Local here = local(x_m, y_m);
  const double u = here.u, v = here.v;  // not a structured binding: Clang 14 cannot capture those
  const double reach = upper_m / grid.resolution_m;
  double best_squared = std::pow(best.distance_m / grid.resolution_m, 2);
  double best_u = 0, best_v = 0;
  bool found = false;
  Layer found_in = Layer::edge;
  const auto consider = [&](double near_u, double near_v) {
    const double squared = (near_u - u) * (near_u - u) + (near_v - v) * (near_v - v);
    if (squared >= best_squared) return false;
    best_squared = squared, best_u = near_u, best_v = near_v, found = true;
    return true;
  };
  if (outside_blocked) {
    const bool inside = u > 0 && v > 0 && u < grid.width && v < grid.height;
    if (inside)
      consider(0, v), consider(grid.width, v), consider(u, 0), consider(u, grid.height);
    else
      consider(u, v);
  }
  const int first_row = std::max(0, static_cast<int>(std::floor(v - reach)));
  const int last_row = static_cast<int>(std::min<double>(grid.height - 1, std::floor(v + reach)));
  const int first_column = std::max(0, static_cast<int>(std::floor(u - reach)));
  const int last_column = static_cast<int>(std::min<double>(grid.width - 1, std::floor(u + reach)));
  for (int row = first_row; row <= last_row; ++row) {
    const double near_v = std::clamp(v, static_cast<double>(row), row + 1.0);
    if ((near_v - v) * (near_v - v) >= best_squared) continue;
    const std::uint8_t* cells =
        blocked.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.width);
    for (int column = first_column; column <= last_column; ++column)
      if (cells[column] != 0 && consider(std::clamp(u, static_cast<double>(column), column + 1.0), near_v))
        found_in = layer_at(grid.index_of({column, row}));
  }
  if (!found) return;
  best.layer = found_in;
  best.distance_m = std::sqrt(best_squared) * grid.resolution_m;
  best.x_m = grid.origin.x_m + (cosine * best_u - sine * best_v) * grid.resolution_m;
  best.y_m = grid.origin.y_m + (sine * best_u + cosine * best_v) * grid.resolution_m;
}

ObstacleField::Bounds ObstacleField::distance_bounds_m(double x_m, double y_m) const {
  Bounds bounds = layers_.front().bounds(x_m, y_m);
  for (std::size_t i = 1; i < layers_.size(); ++i) {
    const Bounds other = layers_[i].bounds(x_m, y_m);
    bounds = {std::min(bounds.lower_m, other.lower_m), std::min(bounds.upper_m, other.upper_m)};
  }
  return bounds;
}

ObstacleField::Nearest ObstacleField::nearest(double x_m, double y_m) const {
  const double upper_m = distance_bounds_m(x_m, y_m).upper_m;
  Nearest best{std::numeric_limits<double>::infinity(), Layer::map, x_m, y_m};
  for (const LayerField& field : layers_) {
    const Bounds bounds = field.bounds(x_m, y_m);
    if (bounds.lower_m > std::min(upper_m, best.distance_m)) continue;
    field.nearest(x_m, y_m, std::min(upper_m, best.distance_m) + field.grid.resolution_m, best);
  }
  return best;
}

double ObstacleField::distance_m(double x_m, double y_m) const { return nearest(x_m, y_m).distance_m; }

bool ObstacleField::disc_free(double x_m, double y_m, double radius_m) const {
  const Bounds bounds = distance_bounds_m(x_m, y_m);
  if (bounds.lower_m >= radius_m) return true;
  if (bounds.upper_m < radius_m) return false;
  return distance_m(x_m, y_m) >= radius_m;
}

ObstacleField::Extent ObstacleField::extent_m() const {
  const OccupancyGrid& grid = layers_.front().grid;
  Extent extent{grid.origin.x_m, grid.origin.x_m, grid.origin.y_m, grid.origin.y_m};
  for (const auto& [u, v] :
       {std::array<int, 2>{grid.width, 0}, {0, grid.height}, {grid.width, grid.height}}) {
    const auto center = grid.center_of({u, v});
    const double half_m = 0.5 * grid.resolution_m;
    const double c = std::cos(grid.origin.heading_rad), s = std::sin(grid.origin.heading_rad);
    const double x = center[0] - half_m * (c - s), y = center[1] - half_m * (s + c);
    extent = {std::min(extent.x_min_m, x), std::max(extent.x_max_m, x), std::min(extent.y_min_m, y),
              std::max(extent.y_max_m, y)};
  }
  return extent;
}

std::vector<Pose> ObstacleField::convex_corners() const {
  std::vector<Pose> corners;
  for (const LayerField& field : layers_) {
    const OccupancyGrid& grid = field.grid;
    const auto blocked = [&](int column, int row) {
      const OccupancyGrid::CellIndex cell{column, row};
      return grid.contains(cell) ? field.blocked[grid.index_of(cell)] != 0 : field.outside_blocked;
    };
    for (int row = 0; row < grid.height; ++row)
      for (int column = 0; column < grid.width; ++column) {
        if (!blocked(column, row)) continue;
        for (const int dx : {-1, 1})
          for (const int dy : {-1, 1}) {
            if (blocked(column + dx, row) || blocked(column, row + dy)) continue;
            const auto center = grid.center_of({column, row});
            const double heading_rad = grid.origin.heading_rad + std::atan2(dy, dx),
                         half_m = std::sqrt(0.5) * grid.resolution_m;
            corners.push_back({center[0] + half_m * std::cos(heading_rad),
                               center[1] + half_m * std::sin(heading_rad), heading_rad});
          }
      }
  }
  return corners;
}

}  // namespace joulepath
