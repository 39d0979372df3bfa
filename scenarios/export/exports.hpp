#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "planner/controller/controlled_drive.hpp"
#include "planner/values/mission_request.hpp"
#include "scenarios/registry.hpp"

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

/// All formats: one file of this folder each, then those of the extensions.
[[nodiscard]] const std::vector<ExportFormat>& export_formats();

[[nodiscard]] Export export_nav2_path(const ExportInput& input);   ///< nav_msgs/Path
[[nodiscard]] Export export_trajectory(const ExportInput& input);  ///< nav_msgs/Trajectory
[[nodiscard]] Export export_plotjuggler(const ExportInput& input);
[[nodiscard]] Export export_edges(const ExportInput& input);  ///< CSV, or JSON by the file's extension

/// `loss` of controller.json, and the extra file beside exports that cannot contain it (schema
/// joulepath/loss/1).
[[nodiscard]] std::string loss_json_text(const ControllerLoss& loss, const std::string& what);

}  // namespace joulepath
