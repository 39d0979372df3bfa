#include <filesystem>

#include "extensions/vda5050/order_json.hpp"

namespace joulepath {

Export export_vda5050(const ExportInput& input) {
  const auto drive_under = [&](const PartSpeeds& speeds) {
    return drive_by_controller(input.plan, fastest_settings,
                               [&](const StretchPlace& place, const StretchPlan& stretch) {
                                 return caps_on(speeds, place, stretch, input.plan.legs[place.leg]);
                               });
  };
  const double scale = scale_for_plan_time(
      input.plan, [&](double trial) { return drive_under(part_speeds(input.plan, trial)); });
  const PartSpeeds speeds = part_speeds(input.plan, scale);
  const ControllerLoss loss = loss_of(input.plan, drive_under(speeds));
  const auto order =
      input.mission.order_file.empty() ? order_of_plan(input, speeds) : order_with_speeds(input, speeds);
  return {.files = {{input.out_file, order.dump(1) + "\n"},
                    {std::filesystem::path(input.out_file).replace_extension(".loss.json").string(),
                     loss_json_text(loss, "vda5050")}},
          .loss = loss};
}

}  // namespace joulepath
