#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "planner/controller/controlled_drive.hpp"
#include "planner/values/mission_request.hpp"

namespace joulepath {

/// A valid plan with its inputs.
struct ExportInput {
  const MissionRequest& mission;
  const MissionWorld& world;
  const Plan& plan;
  const Plant& plant;
  std::string out_file{};           ///< as on the command line
  std::optional<double> rate_Hz{};  ///< of samples, if the format has a rate
};

/// One file of an export.
struct ExportFile {
  std::string name{};
  std::string content{};
};

/// The files of an export, the requested one first; for settings also the energy that they lose.
struct Export {
  std::vector<ExportFile> files{};
  std::optional<ControllerLoss> loss{};
};

struct ExportFormat {
  std::string name{};
  std::string says{};
  Export (*write)(const ExportInput&){};
};

/// All formats: one file of this folder each.
[[nodiscard]] const std::vector<ExportFormat>& export_formats();

[[nodiscard]] Export export_nav2_path(const ExportInput& input);   ///< nav_msgs/Path
[[nodiscard]] Export export_trajectory(const ExportInput& input);  ///< nav_msgs/Trajectory
[[nodiscard]] Export export_plotjuggler(const ExportInput& input);
[[nodiscard]] Export export_bag(const ExportInput& input);    ///< MCAP: Path, Odometry, power
[[nodiscard]] Export export_edges(const ExportInput& input);  ///< CSV, or JSON by the file's extension
[[nodiscard]] Export export_controller(const ExportInput& input);
[[nodiscard]] Export export_nav2_settings(const ExportInput& input);  ///< YAML
[[nodiscard]] Export export_vda5050(const ExportInput& input);
[[nodiscard]] Export export_speed_mask(const ExportInput& input);

/// A run log as a bag (MCAP): Path, Odometry, and every column of the log as JSON. Its clock is that of the
/// log, so that the bag of a plan and that of its run lie on each other; one that begins below 0 begins at 0.
/// Throws ConfigError for times that no stamp holds.
[[nodiscard]] std::string log_bag(const Trajectory& log, const Geometry& geometry);

/// `loss` of controller.json, and the extra file beside exports that cannot contain it (schema
/// joulepath/loss/1).
[[nodiscard]] std::string loss_json_text(const ControllerLoss& loss, const std::string& what);

}  // namespace joulepath
