#include "planner/ways/dear_floor.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "model/limit_table.hpp"
#include "planner/path/floor/distance_transform.hpp"

namespace joulepath {
namespace {

constexpr double kHeldBack = 0.9;  ///< of the robot's speed: a cap below it is dear
constexpr double kLook_m = 0.1;    ///< between looks along a path
constexpr double kBeside_m = 0.5;  ///< a path so near leads along a part: it may shrink from entering it
/// Of an obstacle's reach: a corner of a part that is so far outside of what is closed is still kept.
constexpr double kCorner = 0.7;
constexpr std::int8_t kClosed = 100;

bool in_dear_patch(const Plant& plant, double x_m, double y_m) {
  bool dear = false;
  for (const Effect& effect : plant.effects)
    std::visit(
        [&](const auto& e) {
          if constexpr (requires { e.contains(x_m, y_m) && e.coefficient > 0; })
            dear = dear || (e.coefficient > 0 && e.contains(x_m, y_m));
        },
        effect);
  return dear;
}

bool has_patch(const Plant& plant) {
  bool any = false;
  for (const Effect& effect : plant.effects)
    std::visit(
        [&](const auto& e) {
          any = any || requires { e.contains(0.0, 0.0); };
        },
        effect);
  return any;
}

std::vector<std::uint8_t> dear_cells(const MissionWorld& world, const Plant& plant) {
  const OccupancyGrid& map = *world.map;
  std::vector<std::uint8_t> dear(map.cell_count());
  const bool patches = has_patch(plant);
  const double limit_m_s = world.robot.limits ? world.robot.limits->speed_m_s : kNoLimit;
  const double cosine = std::cos(map.origin.heading_rad), sine = std::sin(map.origin.heading_rad);
  for (std::size_t i = 0; i < dear.size(); ++i) {
    const auto [x_m, y_m] = map.center_of(map.cell_at(i), cosine, sine);
    bool is = patches && in_dear_patch(plant, x_m, y_m);
    if (!is && world.speed_mask && std::isfinite(limit_m_s)) {
      const auto cap_m_s = world.speed_mask->speed_cap_m_s(x_m, y_m, limit_m_s);
      is = cap_m_s && *cap_m_s < kHeldBack * limit_m_s;
    }
    dear[i] = is;
  }
  return dear;
}

}  // namespace

DearFloor::DearFloor(const MissionWorld& world, const Plant& plant, const RouteSpace* space)
    : world_(world), space_(space) {
  if (space && (world.speed_mask || has_patch(plant))) label(dear_cells(world, plant));
}

/// Numbers the connected parts and measures them.
void DearFloor::label(const std::vector<std::uint8_t>& dear) {
  const OccupancyGrid& map = *world_.map;
  std::vector<std::uint8_t> cheap(dear.size());
  std::transform(dear.begin(), dear.end(), cheap.begin(), [](std::uint8_t cell) { return cell == 0; });
  inside_m_ = squared_distance_transform(cheap, map.width, map.height);
  for (float& squared : inside_m_)
    squared = static_cast<float>(std::sqrt(static_cast<double>(squared)) * map.resolution_m);
  part_.assign(dear.size(), -1);
  std::vector<std::size_t> open;
  for (std::size_t first = 0; first < dear.size(); ++first) {
    if (!dear[first] || part_[first] >= 0) continue;
    const int part = static_cast<int>(depth_m_.size());
    depth_m_.push_back(0);
    part_[first] = part;
    open.push_back(first);
    while (!open.empty()) {
      const auto cell = map.cell_at(open.back());
      depth_m_.back() = std::max(depth_m_.back(), inside_m_[open.back()]);
      open.pop_back();
      for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        const OccupancyGrid::CellIndex next{cell.column + dx, cell.row + dy};
        if (!map.contains(next) || !dear[map.index_of(next)] || part_[map.index_of(next)] >= 0) continue;
        part_[map.index_of(next)] = part;
        open.push_back(map.index_of(next));
      }
    }
  }
}

std::optional<int> DearFloor::part(double x_m, double y_m) const {
  if (part_.empty()) return std::nullopt;
  const auto cell = world_.map->cell_of(x_m, y_m);
  if (!world_.map->contains(cell)) return std::nullopt;
  const int part = part_[world_.map->index_of(cell)];
  return part < 0 ? std::nullopt : std::optional(part);
}

DearFloor::Parts DearFloor::at(const std::vector<Point2>& places_m) const {
  Parts parts;
  for (const auto& [x_m, y_m] : places_m)
    if (const auto here = part(x_m, y_m)) parts.push_back(*here);
  std::sort(parts.begin(), parts.end());
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
  return parts;
}

DearFloor::Parts DearFloor::along(const std::vector<Path>& paths) const {
  std::vector<Point2> places_m;
  for (const Path& path : paths)
    for (const PathPiece& piece : path.pieces) {
      if (is_turn(piece)) continue;
      const double length_m = piece_length(piece);
      const int looks = 1 + static_cast<int>(length_m / kLook_m);
      for (int i = 0; i <= looks; ++i) {
        const Pose pose = piece_point(piece, length_m * i / looks).pose;
        for (const double dx_m : {-kBeside_m, 0.0, kBeside_m})
          for (const double dy_m : {-kBeside_m, 0.0, kBeside_m})
            places_m.push_back({pose.x_m + dx_m, pose.y_m + dy_m});
      }
    }
  return at(places_m);
}

const RouteSpace& DearFloor::without(const Parts& parts) const {
  const FootprintChecker& checker = space_->checker();
  const double kept_m = kCorner * (checker.inscribed_radius_m() + checker.clearance_m());
  OccupancyGrid map = *world_.map;
  for (std::size_t i = 0; i < part_.size(); ++i) {
    if (!std::binary_search(parts.begin(), parts.end(), part_[i])) continue;
    const float deepest_m = depth_m_[static_cast<std::size_t>(part_[i])];
    if (inside_m_[i] >= std::min(static_cast<float>(kept_m), deepest_m)) map.occupancy_percent[i] = kClosed;
  }
  return space_->on(map, [&] {
    return RouteSpace(map, world_.keepout ? &*world_.keepout : nullptr, world_.robot.footprint,
                      checker.clearance_m());
  });
}

}  // namespace joulepath
