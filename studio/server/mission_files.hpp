#pragma once

#include <functional>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "planner/values/mission_request.hpp"

namespace joulepath::studio {

/// A mission's file and its robot's, as the page reads and saves them. No name of a file comes from the page:
/// it saves to the mission's own file, and to its robot's where that lies in the mission's folder, or else to
/// MISSION_robot.yaml there, which the mission then names.
class MissionFiles {
 public:
  /// Replaces a file as a whole or not at all.
  using Writer = std::function<void(const std::string& file, const std::string& content)>;

  MissionFiles(std::string mission_file, Writer write);

  [[nodiscard]] const std::string& mission_file() const { return mission_file_; }
  [[nodiscard]] std::string folder() const;
  /// The files of the mission's floor, read.
  [[nodiscard]] MissionWorld read_floor() const;

  /// {name, mission_file, robot_file, mission, robot, base: {mission, robot}}: values and texts as they are
  /// on the disk now. Throws ConfigError.
  [[nodiscard]] nlohmann::ordered_json load() const;

  /// Saves {mission, robot, base}: only the text of changed values is replaced. {conflict: file} where a file
  /// is no longer as `base` has it; else what load() then gives. Throws ConfigError for values that no reader
  /// takes; nothing is written then.
  [[nodiscard]] nlohmann::ordered_json save(const nlohmann::ordered_json& question);

 private:
  [[nodiscard]] std::string robot_file() const;
  [[nodiscard]] std::string robot_target() const;

  std::string mission_file_;
  Writer write_;
  std::mutex saving_{};
};

}  // namespace joulepath::studio
