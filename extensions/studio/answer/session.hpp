#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "planner/mission/mission.hpp"

namespace joulepath::studio {

/// A floor on which missions are planned repeatedly. It answers the questions of the studio's page, in the
/// program or as WebAssembly compiled from the same code. Safe to use from several threads.
///
/// A question is {mode, mission, robot, paths, samples, ...}: mission and robot as their files in JSON,
/// `paths` per leg from an earlier answer (path_json.hpp) or null. Modes:
///   plan      the mission as given, with route search: the result of `joulepath plan --solver fast`
///   paths     certified along the given paths; paths of legs to stations are moved with their stops
///   draft     the same as drafts: limits hold at nodes only, no bound
///   front     least energy for each duration along the given paths (`points`)
///   classics  classic profiles on the given paths in the plan's times
/// The answer is {plan, legs, motion, ...}, or {error: {message, key, found, accepted, hint}}.
class Session {
 public:
  /// `folder`: file names in missions are relative to it.
  Session(MissionWorld floor, std::string folder);
  ~Session();

  [[nodiscard]] std::string answer(const std::string& question) const;

 private:
  std::shared_ptr<const RouteSpace> space_for(const MissionRequest& mission, const Robot& robot) const;
  std::string checked_answer(const nlohmann::json& question) const;

  MissionWorld floor_;  ///< its robot is not used
  std::string folder_;
  mutable std::mutex lock_{};
  mutable std::string space_key_{};
  mutable std::shared_ptr<const RouteSpace> space_{};
};

}  // namespace joulepath::studio
