#include "extensions/studio/answer/grid_json.hpp"

#include <nlohmann/json.hpp>

#include "model/config_error.hpp"

namespace joulepath::studio {
namespace {

using nlohmann::json;
constexpr std::size_t kMostCells = std::size_t{1} << 27;

[[noreturn]] void refuse(const char* found) {
  throw ConfigError({{}, "map", found, "a grid with a run for every cell", ""});
}

std::optional<OccupancyGrid> optional_grid(const json& floor, const char* key) {
  if (!floor.contains(key) || floor.at(key).is_null()) return std::nullopt;
  return grid_from(floor.at(key));
}

}  // namespace

json grid_json(const OccupancyGrid& grid) {
  json runs = json::array();
  const auto& cells = grid.occupancy_percent;
  for (std::size_t k = 0; k < cells.size();) {
    std::size_t end = k;
    while (end < cells.size() && cells[end] == cells[k]) ++end;
    runs.push_back(static_cast<int>(cells[k]));
    runs.push_back(end - k);
    k = end;
  }
  return {{"width", grid.width},
          {"height", grid.height},
          {"resolution_m", grid.resolution_m},
          {"origin", {grid.origin.x_m, grid.origin.y_m, grid.origin.heading_rad}},
          {"runs", std::move(runs)}};
}

OccupancyGrid grid_from(const json& from) {
  const auto origin = from.at("origin").get<std::array<double, 3>>();
  OccupancyGrid grid{.width = from.at("width").get<int>(),
                     .height = from.at("height").get<int>(),
                     .resolution_m = from.at("resolution_m").get<double>(),
                     .origin = {origin[0], origin[1], origin[2]},
                     .occupancy_percent = {},
                     .file = "map"};
  if (grid.width <= 0 || grid.height <= 0 || !(grid.resolution_m > 0)) refuse("a grid without a size");
  const std::size_t cells = static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height);
  if (cells > kMostCells) refuse("a grid of too many cells");
  const auto runs = from.at("runs").get<std::vector<long>>();
  for (std::size_t k = 0; k + 1 < runs.size(); k += 2) {
    if (runs[k + 1] < 0 || static_cast<std::size_t>(runs[k + 1]) > cells - grid.occupancy_percent.size())
      refuse("runs of another length");
    grid.occupancy_percent.insert(grid.occupancy_percent.end(), static_cast<std::size_t>(runs[k + 1]),
                                  static_cast<std::int8_t>(runs[k]));
  }
  if (grid.occupancy_percent.size() != cells) refuse("runs of another length");
  return grid;
}

json floor_json(const MissionWorld& world) {
  json floor{{"map", nullptr}, {"keepout", nullptr}, {"speed_mask", nullptr}};
  if (world.map) floor["map"] = grid_json(*world.map);
  if (world.keepout) floor["keepout"] = grid_json(*world.keepout);
  if (world.speed_mask)
    floor["speed_mask"] = {{"grid", grid_json(world.speed_mask->grid)},
                           {"absolute", world.speed_mask->kind == SpeedMask::Kind::absolute},
                           {"base", world.speed_mask->base},
                           {"multiplier", world.speed_mask->multiplier}};
  return floor;
}

MissionWorld floor_from(const json& floor) {
  MissionWorld world;
  world.map = optional_grid(floor, "map");
  world.keepout = optional_grid(floor, "keepout");
  if (floor.contains("speed_mask") && !floor.at("speed_mask").is_null()) {
    const json& mask = floor.at("speed_mask");
    world.speed_mask =
        SpeedMask{grid_from(mask.at("grid")),
                  mask.at("absolute").get<bool>() ? SpeedMask::Kind::absolute : SpeedMask::Kind::percent,
                  mask.at("base").get<double>(), mask.at("multiplier").get<double>()};
  }
  return world;
}

}  // namespace joulepath::studio
