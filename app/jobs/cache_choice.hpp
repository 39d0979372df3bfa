#pragma once

#include <memory>
#include <string>

#include "planner/cache/answer_cache.hpp"
#include "planner/values/mission_request.hpp"

namespace joulepath {

class CommandLine;

/// Where a command caches answers between runs.
struct CacheChoice {
  std::string folder{};  ///< empty: the default
  bool none{};           ///< nothing on disk
};
void add_cache_options(CommandLine& line, CacheChoice& choice);

/// A cache in memory, and on disk as chosen.
[[nodiscard]] std::unique_ptr<AnswerCache> answer_cache(const CacheChoice& choice);

/// Identifies a floor: the content of all maps and graphs, and the clearance.
[[nodiscard]] ContentKey floor_key(const MissionRequest& mission, const MissionWorld& world);

/// The world of missions on that floor with this robot; answers of another build are those of another world.
[[nodiscard]] ContentKey world_key(const ContentKey& floor, const Robot& robot);

}  // namespace joulepath
