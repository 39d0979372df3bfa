#pragma once

#include <functional>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "planner/values/mission_request.hpp"

namespace joulepath::studio {

/// The files of a mission and of its robot, which the page reads and saves. The page never chooses a file
/// name. It saves to the mission's own file, and to its robot's file if that is in the mission's folder;
/// otherwise to MISSION_robot.yaml there, and the mission then refers to that file.
class MissionFiles {
 public:
  /// Replaces a file completely or leaves it unchanged.
  using Writer = std::function<void(const std::string& file, const std::string& content)>;

  MissionFiles(std::string mission_file, Writer write);

  [[nodiscard]] const std::string& mission_file() const { return mission_file_; }
  [[nodiscard]] std::string folder() const;
  /// The files of the mission's floor, read.
  [[nodiscard]] MissionWorld read_floor() const;

  /// {name, mission_file, robot_file, mission, robot, base: {mission, robot}}: the present values and texts
  /// of the files. Throws ConfigError.
  [[nodiscard]] nlohmann::ordered_json load() const;

  /// Saves {mission, robot, base} and replaces only the text of changed values. Returns {conflict: file}
  /// where a file no longer equals `base`, else the result of load(). Throws ConfigError for values that the
  /// readers reject and for other names of files, and writes nothing then.
  [[nodiscard]] nlohmann::ordered_json save(const nlohmann::ordered_json& question);

 private:
  [[nodiscard]] std::string robot_file() const;
  /// The file in the mission's folder for a robot that lies elsewhere.
  [[nodiscard]] std::string copied_robot() const;
  /// load() of these texts.
  [[nodiscard]] nlohmann::ordered_json state(const std::string& mission_text, const std::string& robot,
                                             const std::string& robot_text) const;

  std::string mission_file_;
  Writer write_;
  std::mutex saving_{};
};

}  // namespace joulepath::studio
