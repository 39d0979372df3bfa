#include <filesystem>
#include <sstream>

#include "extensions/nav2/exports.hpp"
#include "extensions/nav2/speed_grid.hpp"
#include "planner/controller/planned_speed.hpp"

namespace joulepath {
namespace {

constexpr double kResolution_m = 0.1;
constexpr double kReach_m = 0.5;  ///< on both sides of the path, for a robot that does not follow it exactly

std::string pgm_text(const OccupancyGrid& grid) {
  std::string text = "P5\n" + std::to_string(grid.width) + " " + std::to_string(grid.height) + "\n255\n";
  for (int row = grid.height - 1; row >= 0; --row)
    for (int column = 0; column < grid.width; ++column)
      text += static_cast<char>(static_cast<unsigned char>(grid.at({column, row})));
  return text;
}

std::string yaml_text(const SpeedMask& mask, const std::string& image) {
  std::ostringstream text;
  text.precision(12);
  text << "# Speed mask of a plan. For Nav2's costmap filter info server: type: 2, base: 0.0, multiplier: "
       << mask.multiplier
       << "\n# For a mission: speed_mask: {file: ..., kind: absolute, base: 0, multiplier: "
       << mask.multiplier << "}\nimage: " << image << "\nmode: raw\nresolution: " << mask.grid.resolution_m
       << "\norigin: [" << mask.grid.origin.x_m << ", " << mask.grid.origin.y_m
       << ", 0]\nnegate: 0\noccupied_thresh: 1.0\nfree_thresh: 0.0\n";
  return text.str();
}

}  // namespace

Export export_speed_mask(const ExportInput& input) {
  const auto mask_at = [&](double scale) {
    return planned_speed_mask(input.plan, kResolution_m, kReach_m, scale);
  };
  const auto drive_under = [&](const SpeedMask& mask) {
    return drive_by_controller(
        input.plan, fastest_settings,
        [&](const StretchPlace&, const StretchPlan& stretch) { return caps_on(mask, stretch); });
  };
  const double scale =
      scale_for_plan_time(input.plan, [&](double trial) { return drive_under(mask_at(trial)); });
  const SpeedMask mask = mask_at(scale);
  const ControllerLoss loss = loss_of(input.plan, drive_under(mask));
  const std::filesystem::path yaml = input.out_file;
  const std::filesystem::path image = std::filesystem::path(yaml).replace_extension(".pgm");
  return {.files = {{yaml.string(), yaml_text(mask, image.filename().string())},
                    {image.string(), pgm_text(mask.grid)},
                    {std::filesystem::path(yaml).replace_extension(".loss.json").string(),
                     loss_json_text(loss, "speed_mask")}},
          .loss = loss};
}

}  // namespace joulepath
