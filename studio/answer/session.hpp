#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "planner/mission/mission.hpp"

namespace joulepath::studio {

/// A floor on which missions are planned again and again: what the studio's page asks, by the program or by
/// the same code as WebAssembly. Safe to use from several threads.
///
/// A question is {mode, mission, robot, paths, samples, ...}: mission and robot as their files in JSON,
/// `paths` per leg as an earlier answer gave it (path_json.hpp) or null.
///   plan      the mission as asked, routes searched: what `joulepath plan --solver fast` gives
///   paths     certified along the given paths; legs to stations follow theirs, moved to the stops' new
///   places draft     the same in drafts: limits hold at nodes alone, no bound front     least energy for
///   each duration along the given paths (`points`) classics  classic profiles on the given paths in the
///   plan's times
/// The answer is {plan, legs, motion, ...}, or {error: {message, key, found, accepted, hint}}.
class Session {
 public:
  /// `folder`: what file names in missions are relative to.
  Session(MissionWorld floor, std::string folder);
  ~Session();

  [[nodiscard]] std::string answer(const std::string& question) const;

 private:
  std::shared_ptr<const RouteSpace> space_for(const MissionRequest& mission, const Robot& robot) const;
  std::string checked_answer(const nlohmann::json& question) const;

  MissionWorld floor_;  ///< its robot is not looked at
  std::string folder_;
  mutable std::mutex lock_{};
  mutable std::string space_key_{};
  mutable std::shared_ptr<const RouteSpace> space_{};
};

}  // namespace joulepath::studio
