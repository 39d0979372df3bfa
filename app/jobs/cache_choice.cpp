#include "app/jobs/cache_choice.hpp"

#include <cstdlib>

#include "app/build_id.hpp"
#include "app/command_line.hpp"
#include "planner/values/answer_fields.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath {
namespace {

void add(ByteWriter& writer, const OccupancyGrid& grid) {
  const auto& [width, height, resolution_m, origin, occupancy_percent, file] = grid;
  writer(width, height, resolution_m, origin,
         std::string_view(reinterpret_cast<const char*>(occupancy_percent.data()), occupancy_percent.size()));
}

void add(ByteWriter& writer, const RouteGraph& graph) {
  for (const auto& [id, x_m, y_m] : graph.nodes) writer(id, x_m, y_m);
  for (const auto& [id, start, end, speed_limit_m_s, via_m, speed_limit_percent] : graph.edges)
    writer(id, start, end, speed_limit_m_s, via_m, speed_limit_percent);
}

/// ${XDG_CACHE_HOME:-$HOME/.cache}/joulepath; empty where neither variable names a folder.
std::string default_cache_folder() {
  for (const auto& [variable, below] :
       {std::pair{"XDG_CACHE_HOME", "/joulepath"}, {"HOME", "/.cache/joulepath"}})
    if (const char* folder = std::getenv(variable); folder != nullptr && *folder == '/')
      return std::string(folder) + below;
  return "";
}

}  // namespace

void add_cache_options(CommandLine& line, CacheChoice& choice) {
  line.option("--cache", choice.folder,
              "directory in which results about legs are cached for later runs; default: "
              "$XDG_CACHE_HOME/joulepath, at most 512 MiB");
  line.flag("--no-cache", choice.none, "no cache on disk");
}

std::unique_ptr<AnswerCache> answer_cache(const CacheChoice& choice) {
  const std::string folder = choice.folder.empty() ? default_cache_folder() : choice.folder;
  if (choice.none || folder.empty()) return std::make_unique<AnswerCache>();
  return std::make_unique<AnswerCache>(folder);
}

ContentKey floor_key(const MissionRequest& mission, const MissionWorld& world) {
  ByteWriter writer;
  writer(mission.clearance_m);
  for (const auto* grid : {&world.map, &world.keepout}) {
    writer(grid->has_value());
    if (*grid) add(writer, **grid);
  }
  writer(world.speed_mask.has_value(), world.route_graph.has_value());
  if (world.speed_mask) {
    const auto& [grid, kind, base, multiplier] = *world.speed_mask;
    add(writer, grid);
    writer(kind, base, multiplier);
  }
  if (world.route_graph) add(writer, *world.route_graph);
  return content_key(writer.bytes());
}

ContentKey world_key(const ContentKey& floor, const Robot& robot) {
  ByteWriter writer;
  writer(kBuildId, floor.first, floor.second, robot_text(robot));
  return content_key(writer.bytes());
}

}  // namespace joulepath
