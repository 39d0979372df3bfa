#include "extensions/nav2/speed_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planner/legs/stretch.hpp"

namespace joulepath {
namespace {

constexpr int kTop = 100;       ///< largest value of a cell
constexpr double kStep = 0.05;  ///< between sampled places, in cells

struct Sample {
  double x_m{};
  double y_m{};
  double speed_m_s{};
};

/// Places along all curves with the planned speed, at most `step_m` apart.
std::vector<Sample> samples_of(const Plan& plan, double step_m) {
  std::vector<Sample> samples;
  for_each_stretch(plan, [&](const StretchPlace&, const StretchPlan& stretch) {
    if (is_turn(stretch.request.piece)) return;
    const double length_m = piece_length(stretch.request.piece);
    const int count = static_cast<int>(std::ceil(length_m / step_m));
    for (int i = 0; i <= count; ++i) {
      const double s_m = length_m * i / count;
      const Pose pose = piece_point(stretch.request.piece, s_m).pose;
      samples.push_back({pose.x_m, pose.y_m, stretch.profile.at_s(s_m).rate});
    }
  });
  return samples;
}

OccupancyGrid empty_grid(const std::vector<Sample>& samples, double resolution_m, double reach_m) {
  double low_x = std::numeric_limits<double>::infinity(), low_y = low_x, high_x = -low_x, high_y = -low_x;
  for (const Sample& sample : samples) {
    low_x = std::min(low_x, sample.x_m), high_x = std::max(high_x, sample.x_m);
    low_y = std::min(low_y, sample.y_m), high_y = std::max(high_y, sample.y_m);
  }
  const double margin_m = reach_m + resolution_m;
  const auto down = [&](double value) {
    return resolution_m * std::floor((value - margin_m) / resolution_m);
  };
  OccupancyGrid grid{.resolution_m = resolution_m, .origin = {down(low_x), down(low_y), 0}};
  grid.width = static_cast<int>(std::ceil((high_x + margin_m - grid.origin.x_m) / resolution_m));
  grid.height = static_cast<int>(std::ceil((high_y + margin_m - grid.origin.y_m) / resolution_m));
  grid.occupancy_percent.assign(grid.cell_count(), 0);
  return grid;
}

/// Copies the values of crossed cells to the cells within reach; the nearest crossed cell determines the
/// value.
void spread(OccupancyGrid& grid, double reach_m) {
  const std::vector<std::int8_t> crossed = grid.occupancy_percent;
  std::vector<double> nearest(crossed.size(), std::numeric_limits<double>::infinity());
  const int reach = static_cast<int>(std::floor(reach_m / grid.resolution_m));
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const std::int8_t value = crossed[grid.index_of({column, row})];
      if (value == 0) continue;
      for (int up = -reach; up <= reach; ++up)
        for (int right = -reach; right <= reach; ++right) {
          const OccupancyGrid::CellIndex cell{column + right, row + up};
          const double distance = std::hypot(up, right);
          if (!grid.contains(cell) || distance > reach) continue;
          const std::size_t index = grid.index_of(cell);
          if (distance < nearest[index]) nearest[index] = distance, grid.occupancy_percent[index] = value;
        }
    }
}

}  // namespace

SpeedMask planned_speed_mask(const Plan& plan, double resolution_m, double reach_m, double scale) {
  const std::vector<Sample> samples = samples_of(plan, kStep * resolution_m);
  SpeedMask mask{.kind = SpeedMask::Kind::absolute, .base = 0.0, .multiplier = 0.01};
  if (samples.empty()) return mask;
  mask.grid = empty_grid(samples, resolution_m, reach_m);
  std::vector<double> highest(mask.grid.occupancy_percent.size(), 0.0);
  double top_m_s = 0;
  for (const Sample& sample : samples) {
    double& cell = highest[mask.grid.index_of(mask.grid.cell_of(sample.x_m, sample.y_m))];
    cell = std::max(cell, scale * sample.speed_m_s);
    top_m_s = std::max(top_m_s, cell);
  }
  mask.multiplier = std::ceil(1e5 * top_m_s / kTop - 1e-9) / 1e5;
  for (std::size_t k = 0; k < highest.size(); ++k)
    if (highest[k] > 0)
      mask.grid.occupancy_percent[k] = static_cast<std::int8_t>(
          std::clamp(static_cast<int>(std::ceil(highest[k] / mask.multiplier - 1e-9)), 1, kTop));
  spread(mask.grid, reach_m);
  return mask;
}

std::vector<SpeedCap> caps_on(const SpeedMask& mask, const StretchPlan& stretch) {
  return speed_caps_on(stretch.request.piece, 0.0, 0, {}, mask, stretch.request.limits.speed_m_s);
}

}  // namespace joulepath
