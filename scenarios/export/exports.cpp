#include "scenarios/export/exports.hpp"

#include <algorithm>
#include <iterator>

#include "scenarios/export/loss_json.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

Json at_time_json(const LossAtTime& loss) {
  return {{"duration_s", loss.duration_s},
          {"energy_J", loss.energy_J},
          {"optimum_J", loss.optimum_J},
          {"lost_J", loss.lost_J()},
          {"lost_percent", loss.lost_percent()}};
}

}  // namespace

Json loss_json(const ControllerLoss& loss) {
  return {{"own_time", at_time_json(loss.own_time)},
          {"plan_time", loss.plan_time ? at_time_json(*loss.plan_time) : Json(nullptr)},
          {"broken_limit", loss.broken_limit}};
}

std::string loss_json_text(const ControllerLoss& loss, const std::string& what) {
  Json json{{"schema", "joulepath/loss/1"}, {"of", what}};
  json.update(loss_json(loss));
  return json.dump(1) + "\n";
}

const std::vector<ExportFormat>& export_formats() {
  static const std::vector<ExportFormat> formats = [] {
    std::vector<ExportFormat> all{
        {"nav2_path", "poses with stamps, shaped as nav_msgs/Path (JSON, which is YAML too)",
         export_nav2_path},
        {"trajectory", "poses, speeds, accelerations and efforts, shaped as nav_msgs/Trajectory (JSON)",
         export_trajectory},
        {"plotjuggler", "all signals over time, grouped by name (CSV)", export_plotjuggler},
        {"edges",
         "energy and time of each edge, turn and dwell, for a fleet manager (CSV, or JSON by extension)",
         export_edges},
    };
    std::ranges::copy(registry().exports, std::back_inserter(all));
    return all;
  }();
  return formats;
}

}  // namespace joulepath
